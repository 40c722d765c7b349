#include "image/samples.h"

#include "image/texels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace penumbra {
namespace {

// Nearest integer of [0, max]; NaN becomes 0.
unsigned quantise(float value, float max) {
    if (!(value > 0)) return 0;
    return unsigned(std::min(value, 1.0F) * max + 0.5F);
}

// encode() of every channel, appended.
template <class Encode>
void append(std::span<const Color> pixels, std::vector<std::byte>& samples, const Encode& encode) {
    using Sample = decltype(encode(0.0F));
    const std::size_t start = samples.size();
    samples.resize(start + pixels.size() * 3 * sizeof(Sample));
    std::byte* to = samples.data() + start;
    for (const Color& pixel : pixels)
        for (const float value : {pixel.x, pixel.y, pixel.z}) {
            const Sample sample = encode(value);
            std::memcpy(to, &sample, sizeof sample);
            to += sizeof sample;
        }
}

std::uint8_t encoded8(float linear) { return std::uint8_t(quantise(linear_to_srgb(linear), 255)); }

// The same without a power: the least linear value of every 8-bit sample, and where to begin
// looking.
class Encoder8 {
  public:
    Encoder8() {
        for (std::size_t sample = 1; sample < 256; ++sample) {
            std::uint32_t below = 0, at = std::bit_cast<std::uint32_t>(1.0F);  // floats in order
            while (at - below > 1) {
                const std::uint32_t middle = below + (at - below) / 2;
                (encoded8(std::bit_cast<float>(middle)) < sample ? below : at) = middle;
            }
            least_[sample] = std::bit_cast<float>(at);
        }
        least_[256] = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < first_.size(); ++i)
            first_[i] = encoded8(float(i) / float(first_.size()));
    }
    std::uint8_t operator()(float linear) const {
        if (!(linear > 0)) return 0;
        if (linear >= 1) return 255;
        std::size_t sample = first_[std::size_t(linear * float(first_.size()))];
        while (linear >= least_[sample + 1]) ++sample;
        return std::uint8_t(sample);
    }

  private:
    std::array<float, 257> least_ = {};
    std::array<std::uint8_t, 4096> first_ = {};
};

}  // namespace

void append_samples(std::span<const Color> pixels, Depth depth, std::vector<std::byte>& samples) {
    switch (depth) {
    case Depth::f32: return append(pixels, samples, [](float value) { return value; });
    case Depth::u16:
        return append(pixels, samples, [](float value) {
            return std::uint16_t(quantise(linear_to_srgb(value), 65535));
        });
    case Depth::u8: break;
    }
    static const Encoder8 encoder;
    append(pixels, samples, encoder);
}

Image to_image(const Raster& raster) {
    Image image(raster.width, raster.height);
    const LinearSamples samples(raster, true);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = samples.color(i);
    return image;
}

std::uint8_t srgb_byte(float linear) {
    // Fine enough to be off by one code only within a twentieth of a code of the boundary.
    constexpr std::size_t steps = 65535;
    static const std::vector<std::uint8_t> codes = [] {
        std::vector<std::uint8_t> table(steps + 1);
        for (std::size_t i = 0; i <= steps; ++i)
            table[i] = std::uint8_t(std::lround(linear_to_srgb(float(i) / float(steps)) * 255.0F));
        return table;
    }();
    const float inside = std::clamp(linear, 0.0F, 1.0F);
    return codes[std::size_t(std::lround(inside * float(steps)))];
}

}  // namespace penumbra
