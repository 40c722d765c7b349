#include "scene/texture/texture_lookup.h"

#include <algorithm>
#include <cmath>

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

Vec3 texel(const TextureLookup& lookup, int column, int row) {
    const int width = lookup.texture->raster.width;
    return Vec3(lookup.samples.color(std::size_t(row) * std::size_t(width) + std::size_t(column)));
}

}  // namespace

Color sample(const TextureLookup& lookup, double u, double v) {
    const Texture& texture = *lookup.texture;
    const int width = texture.raster.width, height = texture.raster.height;
    const Texels x = texels(u * width, width, texture.wrap_u, texture.bilinear, false);
    const Texels y = texels(v * height, height, texture.wrap_v, texture.bilinear, true);
    if (!texture.bilinear) return Color(texel(lookup, x.here, y.here));
    const double p = x.weight, q = y.weight;
    return Color(texel(lookup, x.here, y.here) * (p * q) +
                 texel(lookup, x.before, y.here) * ((1 - p) * q) +
                 texel(lookup, x.here, y.before) * (p * (1 - q)) +
                 texel(lookup, x.before, y.before) * ((1 - p) * (1 - q)));
}

}  // namespace penumbra
