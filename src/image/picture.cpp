// A picture file with its alpha.
#include "penumbra/picture.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/contents.h"
#include "image/samples.h"
#include "image/texels.h"

#include <algorithm>
#include <cstring>

namespace penumbra {
namespace {

// The last channel alone.
Raster alpha_of(const Raster& raster, const std::string& place) {
    Raster alpha = {raster.width, raster.height, 1, raster.depth, {}};
    const auto size = std::size_t(raster.depth), texel = size * std::size_t(raster.channels);
    resize_claimed(alpha.data, raster.texels() * size, place);
    for (std::size_t i = 0; i < raster.texels(); ++i)
        std::memcpy(&alpha.data[i * size], &raster.data[(i + 1) * texel - size], size);
    return alpha;
}

// Stored colours that were multiplied by alpha already; integers were as they are encoded.
Color associated(const Color& stored, float alpha, Depth depth) {
    if (depth == Depth::f32) return stored;
    const auto channel = [alpha](float c) {
        return alpha * srgb_to_linear(std::min(linear_to_srgb(c) / alpha, 1.0F));
    };
    return {channel(stored.x), channel(stored.y), channel(stored.z)};
}

void multiply(Picture& picture, bool is_associated) {
    const LinearSamples alpha(picture.alpha, false);
    for (std::size_t i = 0; i < picture.colors.pixels.size(); ++i) {
        Color& color = picture.colors.pixels[i];
        if (alpha[i] == 0)
            color = Color(0);
        else if (is_associated)
            color = associated(color, alpha[i], picture.alpha.depth);
        else
            color *= alpha[i];
    }
}

bool is_one_everywhere(const Raster& alpha) {
    const LinearSamples samples(alpha, false);
    for (std::size_t i = 0; i < alpha.texels(); ++i)
        if (samples[i] != 1) return false;
    return true;
}

}  // namespace

Picture load_picture(const std::filesystem::path& file, bool ignore_alpha) {
    const std::string place = file.string();
    Picture picture;
    Contents contents;
    Raster raster;
    {
        const std::vector<std::byte> bytes = read_bytes(file);
        raster = decode_image(bytes, place);
        contents = contents_of(bytes);
    }
    for (const std::string& what : contents.unread)
        picture.losses.push_back({Loss::dropped, place, what});
    {
        const MemoryClaim claim(times(raster.texels(), sizeof(Color)), place);
        picture.colors = to_image(raster);
    }
    if (raster.channels != 2 && raster.channels != 4) return picture;
    picture.use = ignore_alpha ? Alpha::ignored : Alpha::counted;
    if (ignore_alpha) return picture;
    picture.alpha = alpha_of(raster, place);
    if (is_one_everywhere(picture.alpha))
        picture.alpha.data = {};
    else
        multiply(picture, contents.associated_alpha);
    return picture;
}

}  // namespace penumbra
