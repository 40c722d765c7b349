// The samples of images as linear values, and what importers compute from them.
#pragma once

#include "penumbra/image.h"

#include <array>
#include <cstring>
#include <optional>
#include <vector>

namespace penumbra {

/// The samples of a raster as linear values: integers in [0, 1], decoded where they are
/// sRGB-encoded, and floats as they are. Refers to Raster::data, which must stay.
class LinearSamples {
  public:
    LinearSamples() = default;
    LinearSamples(const Raster& raster, bool srgb);

    /// By the position in Raster::data, counted in samples.
    float operator[](std::size_t at) const {
        switch (depth_) {
        case Depth::u8: return from_u8(at);
        case Depth::u16: return from_u16(at);
        case Depth::f32: break;
        }
        return from_f32(at);
    }
    /// The texel without its alpha, grey in all three channels; texels count from the top left.
    Color color(std::size_t texel) const {
        const std::size_t first = texel * channels_;
        switch (depth_) {  // once for all three
        case Depth::u8: return three(first, [this](std::size_t at) { return from_u8(at); });
        case Depth::u16: return three(first, [this](std::size_t at) { return from_u16(at); });
        case Depth::f32: break;
        }
        return three(first, [this](std::size_t at) { return from_f32(at); });
    }

  private:
    const std::byte* data_ = nullptr;
    const float* decoded_ = nullptr;  // of every integer sample
    std::size_t channels_ = 1;
    Depth depth_ = Depth::u8;

    float from_u8(std::size_t at) const {
        return decoded_[std::to_integer<std::size_t>(data_[at])];
    }
    float from_u16(std::size_t at) const { return decoded_[read<std::uint16_t>(at)]; }
    float from_f32(std::size_t at) const { return read<float>(at); }
    template <class Sample>
    Sample read(std::size_t at) const {
        Sample sample;
        std::memcpy(&sample, data_ + at * sizeof sample, sizeof sample);
        return sample;
    }
    template <class Read>
    Color three(std::size_t first, const Read& sample) const {
        if (channels_ < 3) return Color(sample(first));
        return {sample(first), sample(first + 1), sample(first + 2)};
    }
};

/// Some texels of an image, by their position in it.
using TexelMask = std::vector<bool>;

/// offset + factor x the samples of an image, one channel or three of it; without an image
/// offset + factor.
struct TexelSource {
    const Raster* raster = nullptr;  ///< none: the factor everywhere
    int channel = 0;                 ///< the first one; 3: alpha. Of grey images any is the same
    bool single = false;             ///< that one only, in all three of the colour
    bool srgb = false;               ///< integer samples are sRGB-encoded
    Color factor = Color(1);
    float offset = 0;
    const TexelMask* only = nullptr;  ///< for what is said of all texels: those that count
};

/// Reads a TexelSource as linear values; floats that are not finite count as 0.
class TexelReader {
  public:
    explicit TexelReader(const TexelSource& given);

    /// One value, of the first channel; the row counts from the top.
    float value(int x, int y) const;
    /// Three channels.
    Color color(int x, int y) const;

  private:
    TexelSource source_ = {};
    LinearSamples samples_ = {};
    bool varies_ = false;                      ///< there are samples to be read
    std::array<std::size_t, 3> offsets_ = {};  ///< of the channels, in samples
    float at(int x, int y, int channel) const;
};

/// The mean of a source's colour.
Color mean_of(const TexelSource& source);

/// The least and the largest value of a source's first channel.
std::array<float, 2> range_of(const TexelSource& source);

/// The colour that all texels have, if they are equal.
std::optional<Color> constant_of(const TexelSource& source);

/// Their mean, if none differs from another by more than a step of an image of 8 bits.
std::optional<Color> even_of(const TexelSource& source);

/// True when some texel is not opaque.
bool has_transparency(const Raster& raster);

/// The first channel of `source` as a grey image of the depth of its raster, linear.
Raster grey_of(const TexelSource& source);

/// `raster` with base + gain x s for every sample s, in [0, 1] as it is encoded, alpha apart.
Raster remapped(Raster raster, double base, double gain);

}  // namespace penumbra
