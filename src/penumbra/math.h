// Vectors, matrices and colours: the names that penumbra uses for Imath's types, and how colours
// are encoded.
#pragma once

#include <ImathMatrix.h>
#include <ImathVec.h>

#include <cstdint>
#include <numbers>

namespace penumbra {

using Vec2 = Imath::V2d;
using Vec3 = Imath::V3d;
using Vec2f = Imath::V2f;
using Vec3f = Imath::V3f;

/// Linear-light RGB with Rec. 709 / sRGB primaries, in float32 as POV-Ray keeps it; no upper bound.
using Color = Imath::V3f;

/// sRGB decoding of one channel, IEC 61966-2-1, in float32 exactly as POV-Ray does it.
float srgb_to_linear(float encoded);
/// sRGB encoding of one linear channel; no clamping (negative values map linearly).
float linear_to_srgb(float linear);

/// An affine transform of row vectors, p' = p * M: the memory order is that of glTF's column-major
/// `matrix`, and rows 0 to 3 without their last element are POV-Ray's `matrix <...>`.
using Matrix = Imath::M44d;

/// Position in one of the Scene's vectors.
using Index = std::uint32_t;
inline constexpr Index no_index = 0xffffffff;

constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180); }
constexpr double degrees(double radians) { return radians * (180 / std::numbers::pi); }

}  // namespace penumbra
