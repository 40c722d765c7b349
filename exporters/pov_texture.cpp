#include "pov_plan.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace penumbra::pov {

namespace {

constexpr float largest_half = 65504;

// The texel of the texture at position `index` of an endless row.
int wrapped(int index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(index, 0, size - 1);
    const int period = wrap == Wrap::mirror ? 2 * size : size;
    index = (index % period + period) % period;
    return index < size ? index : period - 1 - index;
}

// OpenEXR's halves end at 65504; infinity would spread to every texel that is mixed with it.
void limit_floats(Raster& raster) {
    for (std::size_t i = 0; i + sizeof(float) <= raster.data.size(); i += sizeof(float)) {
        float value = 0;
        std::memcpy(&value, raster.data.data() + i, sizeof value);
        value = std::isnan(value) ? 0 : std::clamp(value, -largest_half, largest_half);
        std::memcpy(raster.data.data() + i, &value, sizeof value);
    }
}

}  // namespace

Raster baked(const Texture& texture, const TextureFile& file) {
    const Raster& in = texture.raster;
    const auto sample = std::size_t(in.depth), channels = std::size_t(in.channels);
    Raster out{.width = file.u.count, .height = file.v.count, .channels = 3, .depth = in.depth};
    out.data.resize(out.texels() * 3 * sample);
    std::byte* to = out.data.data();
    for (int row = 0; row < out.height; ++row) {
        // Rows of files count from the top, texture coordinates from the bottom.
        const int from_bottom = file.v.first + out.height - 1 - row;
        const int source_row = in.height - 1 - wrapped(from_bottom, in.height, texture.wrap_v);
        const std::size_t line = std::size_t(source_row) * std::size_t(in.width);
        for (int column = 0; column < out.width; ++column) {
            const int source = wrapped(file.u.first + column, in.width, texture.wrap_u);
            const std::byte* from =
                in.data.data() + (line + std::size_t(source)) * channels * sample;
            // POV-Ray decodes 8-bit grey files to 8 linear bits, so grey is written as RGB.
            for (std::size_t c = 0; c < 3; ++c, to += sample)
                std::memcpy(to, from + (channels >= 3 ? c * sample : 0), sample);
        }
    }
    if (out.depth == Depth::f32) limit_floats(out);
    return out;
}

}  // namespace penumbra::pov
