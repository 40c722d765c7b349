// Large simple polygons in the plane -> triangles.
#pragma once

#include "penumbra/math.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace penumbra {

/// The n - 2 triangles of a simple polygon, corners counter-clockwise, in O(n log n); nothing for a
/// polygon that touches or crosses itself or has corners on straight lines.
std::optional<std::vector<std::array<Index, 3>>> triangulate_simple(std::span<const Vec2> corners);

}  // namespace penumbra
