#include "sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra {

namespace {

// One axis of a lookup: the texel that holds the point, the one before it, and the weight of the
// former (bilinear only).
struct Texels {
    int here, before;
    double weight;
};

double positive_remainder(double value, double modulus) {
    double rest = std::fmod(value, modulus);
    if (rest < 0) rest += modulus;
    return rest < modulus ? rest : 0;  // NaN, of coordinates that overflow, becomes 0
}

int wrapped(int index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(index, 0, size - 1);
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    index %= period;
    if (index < 0) index += period;
    return index < size ? index : period - 1 - index;
}

// `position` counts texels from the left (columns) or from the bottom (rows, `from_top`).
// The 1e-10 is POV-Ray's (source/backend/support/imageutil.cpp, image_map): it decides which texel
// a point on a border belongs to.
Texels texels(double position, int size, Wrap wrap, bool bilinear, bool from_top) {
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    double x = 0;
    if (wrap == Wrap::clamp) {
        // Further out every texel is the same, and an int may not hold it.
        x = std::max(-1.0, std::min(size + 1.0, from_top ? size - position : position));
    } else {
        x = std::fmod(position, period) + 1e-10;
        x = positive_remainder(from_top ? -x : x, period);
        // The period, from its top, is the image upside down and then the image.
        if (from_top && wrap == Wrap::mirror) x -= size;
    }
    if (!bilinear) return {wrapped(int(std::floor(x)), size, wrap), 0, 1};
    x += 0.5;
    const double cell = std::floor(x);
    return {wrapped(int(cell), size, wrap), wrapped(int(cell) - 1, size, wrap), x - cell};
}

// Samples `first` and after: grey, or RGB. The depth is looked at once for all three.
template <class Read>
Vec3 read_texel(int channels, std::size_t first, const Read& read) {
    if (channels < 3) return Vec3(read(first));
    return {read(first), read(first + 1), read(first + 2)};
}

Vec3 texel(const Sampler& sampler, int column, int row) {
    const Raster& raster = sampler.texture->raster;
    const std::size_t first = (std::size_t(row) * std::size_t(raster.width) + std::size_t(column)) *
                              std::size_t(raster.channels);
    const std::byte* data = raster.data.data();
    switch (raster.depth) {
    case Depth::u8:
        return read_texel(raster.channels, first, [&](std::size_t i) {
            return sampler.decode[std::to_integer<std::size_t>(data[i])];
        });
    case Depth::u16:
        return read_texel(raster.channels, first, [&](std::size_t i) {
            std::uint16_t word = 0;
            std::memcpy(&word, data + 2 * i, 2);
            return sampler.decode[word];
        });
    case Depth::f32: break;
    }
    return read_texel(raster.channels, first, [&](std::size_t i) {
        float value = 0;
        std::memcpy(&value, data + 4 * i, 4);
        return value;
    });
}

}  // namespace

Sampler make_sampler(const Texture& texture) {
    Sampler sampler = {.texture = &texture};
    if (texture.raster.depth == Depth::f32) return sampler;
    const std::size_t levels = texture.raster.depth == Depth::u8 ? 256 : 65536;
    sampler.decode.resize(levels);
    for (std::size_t i = 0; i < levels; ++i) {
        const float encoded = float(i) / float(levels - 1);
        sampler.decode[i] = texture.srgb ? srgb_to_linear(encoded) : encoded;
    }
    return sampler;
}

Color sample(const Sampler& sampler, double u, double v) {
    const Texture& texture = *sampler.texture;
    const int width = texture.raster.width, height = texture.raster.height;
    const Texels x = texels(u * width, width, texture.wrap_u, texture.bilinear, false);
    const Texels y = texels(v * height, height, texture.wrap_v, texture.bilinear, true);
    if (!texture.bilinear) return Color(texel(sampler, x.here, y.here));
    const double p = x.weight, q = y.weight;
    return Color(texel(sampler, x.here, y.here) * (p * q) +
                 texel(sampler, x.before, y.here) * ((1 - p) * q) +
                 texel(sampler, x.here, y.before) * (p * (1 - q)) +
                 texel(sampler, x.before, y.before) * ((1 - p) * (1 - q)));
}

}  // namespace penumbra
