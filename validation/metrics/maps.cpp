// Pictures of differences.
#include "validation/metrics/maps.h"

#include "validation/metrics/picture.h"

#include "penumbra/compare.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace penumbra {

// The magma colour map of van der Walt and Smith 2015 (CC0), every 17th of its 256 entries.
// Linear interpolation between them stays within 3/255 of the others.
const std::array<unsigned, 16> metrics::magma = {
    0x000004, 0x0b0924, 0x20114b, 0x3b0f70, 0x57157e, 0x721f81, 0x8c2981, 0xa8327d,
    0xc43c75, 0xde4968, 0xf1605d, 0xfa7f5e, 0xfe9f6d, 0xfebf84, 0xfddea0, 0xfcfdbf};

namespace {

// The map's colour at t in [0, 1], linear; NaN shows as the brightest.
Color magma_at(float t) {
    const float place = t < 1 ? std::max(t, 0.F) * 15 : 15;
    const auto low = std::min(std::size_t(place), std::size_t(14));
    const float high_share = place - float(low);
    const auto channel = [&](unsigned shift) {
        const auto byte = [&](std::size_t i) { return float(metrics::magma[i] >> shift & 0xffU); };
        return srgb_to_linear(std::lerp(byte(low), byte(low + 1), high_share) / 255);
    };
    return {channel(16), channel(8), channel(0)};
}

}  // namespace

Image difference(const Image& test, const Image& reference, float gain) {
    metrics::check_fit(test, reference);
    Image result(test.width, test.height);
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        const Color d = (test.pixels[i] - reference.pixels[i]) * gain;
        result.pixels[i] = {std::abs(d.x), std::abs(d.y), std::abs(d.z)};
    }
    return result;
}

Image heat_map(const Image& flip_map) {
    // 4096 steps are more than a display has; the colours are computed once.
    static const std::vector<Color> colors = [] {
        std::vector<Color> result(4096);
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = magma_at(float(i) / 4095);
        return result;
    }();
    Image result(flip_map.width, flip_map.height);
    std::ranges::transform(flip_map.pixels, result.pixels.begin(), [](const Color& error) {
        return colors[error.x < 1 ? std::size_t(std::max(error.x, 0.F) * 4095 + 0.5F) : 4095];
    });
    return result;
}

}  // namespace penumbra
