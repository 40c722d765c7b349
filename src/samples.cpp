#include "samples.h"

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

// The linear value of every integer sample.
template <class Sample>
std::vector<float> decoding_table() {
    const std::size_t max = static_cast<Sample>(~Sample(0));
    std::vector<float> table(max + 1);
    for (std::size_t i = 0; i <= max; ++i) table[i] = srgb_to_linear(float(i) / float(max));
    return table;
}

template <class Sample, class Linear>
void fill(Image& image, const Raster& raster, const Linear& linear) {
    const auto channels = std::size_t(raster.channels);
    const std::array<std::size_t, 3> rgb = {0, channels > 2 ? 1U : 0U, channels > 2 ? 2U : 0U};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            Sample sample;
            std::memcpy(&sample, raster.data.data() + (i * channels + rgb[c]) * sizeof sample,
                        sizeof sample);
            image.pixels[i][int(c)] = linear(sample);
        }
    }
}

}  // namespace

// IEC 61966-2-1, in float32 as POV-Ray 3.7 computes it (source/base/image/colourspace.cpp).
float srgb_to_linear(float encoded) {
    if (encoded < 0.04045F) return encoded / 12.92F;
    return std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

float linear_to_srgb(float linear) {
    if (linear <= 0.0031308F) return linear * 12.92F;
    return 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

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
    if (raster.depth == Depth::u8) {
        static const auto table = decoding_table<std::uint8_t>();
        fill<std::uint8_t>(image, raster, [&](std::uint8_t sample) { return table[sample]; });
    } else if (raster.depth == Depth::u16) {
        static const auto table = decoding_table<std::uint16_t>();
        fill<std::uint16_t>(image, raster, [&](std::uint16_t sample) { return table[sample]; });
    } else {
        fill<float>(image, raster, [](float sample) { return sample; });
    }
    return image;
}

}  // namespace penumbra
