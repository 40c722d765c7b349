// Polygons in space -> triangles.
#pragma once

#include "penumbra/math.h"

#include <array>
#include <span>
#include <vector>

namespace penumbra {

/// A vertex that the polygon lacks: where two edges cross, or where corners coincide.
struct AddedCorner {
    Vec3 position = Vec3(0);
    std::array<Index, 4> from = {};     ///< into the corners, then into the earlier added ones
    std::array<double, 4> weight = {};  ///< of `from`; their sum is 1, 0 where unused
};

struct Triangulation {
    std::vector<std::array<Index, 3>> triangles = {};  ///< into the corners, then into `added`
    std::vector<AddedCorner> added = {};
    double outline = 0;     ///< the polygon's area by Newell's formula
    double area = 0;        ///< of all triangles
    bool crossing = false;  ///< seen along its normal, the polygon overlaps itself
    bool tangled = false;   ///< it crosses itself so often that only a fan could be made
    bool bent = false;      ///< `area` exceeds the flat polygon's by more than 5 %
};

/// The polygon's normal by Newell's formula, twice its area long (Sutherland, Sproull and
/// Schumacker 1974, "A Characterization of Ten Hidden-Surface Algorithms").
Vec3 newell_normal(std::span<const Vec3> corners);

/// Triangulates a polygon of three or more corners, which may be concave or cross itself; what its
/// outline encloses (non-zero winding) is filled. A simple polygon of n corners gives n - 2
/// triangles. Costs O(n log n).
Triangulation triangulate(std::span<const Vec3> corners);

}  // namespace penumbra
