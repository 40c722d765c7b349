// Which transforms an Instance may have.
#pragma once

namespace penumbra {

/// Of a transform's determinant, without its sign: scaled by less than 1e-30 nothing is left of a
/// mesh, and normalise() must still find an inverse.
inline constexpr double least_determinant = 1e-90;

/// Of a transform's numbers, for the same reason.
inline constexpr double largest_in_transform = 1e30;

}  // namespace penumbra
