// Linear colours <-> the samples of picture files.
#pragma once

#include "penumbra/image.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

/// Three samples a pixel, appended to `samples`: integers are clamped to [0, 1] and sRGB-encoded,
/// floats are as they are. NaN becomes the integer 0.
void append_samples(std::span<const Color> pixels, Depth depth, std::vector<std::byte>& samples);

/// The colours of a raster, without alpha: grey in all three channels, integers decoded from sRGB.
Image to_image(const Raster& raster);

/// The 8-bit sRGB code of a linear value, clamped to [0, 1].
std::uint8_t srgb_byte(float linear);

}  // namespace penumbra
