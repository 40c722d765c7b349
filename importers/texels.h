// What importers compute from the samples of images.
#pragma once

#include "penumbra/scene.h"

#include <array>
#include <optional>

namespace penumbra {

/// offset + factor x the samples of an image, one channel or three of it; without an image
/// offset + factor.
struct TexelSource {
    const Raster* raster = nullptr;  ///< none: the factor everywhere
    int channel = 0;                 ///< the first one; 3: alpha. Of grey images any is the same
    bool single = false;             ///< that one only, in all three of the colour
    bool srgb = false;               ///< integer samples are sRGB-encoded
    Color factor = Color(1);
    float offset = 0;
};

/// Reads a TexelSource as linear values.
class TexelReader {
  public:
    explicit TexelReader(const TexelSource& given);

    /// One value, of the first channel; the row counts from the top.
    float value(int x, int y) const;
    /// Three channels.
    Color color(int x, int y) const;

  private:
    TexelSource source = {};
    bool varies = false;                      ///< there are samples to be read
    std::array<std::size_t, 3> offsets = {};  ///< of the channels, in samples
    std::array<float, 256> decoded = {};      ///< 8-bit samples as linear values
    float sample(std::size_t at) const;
    float at(int x, int y, int channel) const;
};

/// The mean of a source's colour.
Color mean_of(const TexelSource& source);

/// The least and the largest value of a source's first channel.
std::array<float, 2> range_of(const TexelSource& source);

/// The colour that all texels have, if they are equal.
std::optional<Color> constant_of(const TexelSource& source);

/// True when some texel is not opaque.
bool has_transparency(const Raster& raster);

/// The first channel of `source` as a grey image of the depth of its raster, linear.
Raster grey_of(const TexelSource& source);

/// `raster` with base + gain x s for every sample s, in [0, 1] as it is encoded, alpha apart.
Raster remapped(Raster raster, double base, double gain);

/// The 8-bit sRGB code of a linear value, clamped to [0, 1].
std::uint8_t srgb_byte(float linear);

}  // namespace penumbra
