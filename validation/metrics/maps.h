// Colours for pictures of differences.
#pragma once

#include <array>

namespace penumbra::metrics {

/// 16 evenly spaced colours of the magma map, sRGB 0xRRGGBB.
extern const std::array<unsigned, 16> magma;

}  // namespace penumbra::metrics
