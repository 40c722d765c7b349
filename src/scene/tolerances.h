// What POV-Ray takes for nothing, and the size that scenes are brought to so that it is little.
#pragma once

namespace penumbra {

// POV-Ray 3.7's tolerances, absolute in scene units (source/backend/configbackend.h).
inline constexpr double least_distance = 1e-4;  ///< of a hit of any but a shadow ray
inline constexpr double shadow_margin = 1e-3;   ///< at both ends of a shadow ray
inline constexpr double least_depth = 1e-6;     ///< of a primitive's hit
inline constexpr double greatest_depth = 1e7;   ///< of a primitive's hit
inline constexpr double least_cosine = 1e-10;   ///< of a ray to a plane, of light to a surface

/// A normalised scene's radius is in [least_radius, 2 least_radius): so large that the tolerances
/// are small, and float32 still far smaller. See docs/decisions/normalised-scale.md.
inline constexpr double least_radius = 128;

/// By so much float32 rounds the coordinates of a normalised scene at most: they are below
/// 4 least_radius, and half of the last of 24 digits is lost.
inline constexpr double coordinate_rounding = 2 * least_radius / (1 << 24);

}  // namespace penumbra
