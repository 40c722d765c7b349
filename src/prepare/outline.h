// Where the things of a scene are, and how far they reach.
#pragma once

#include "penumbra/scene.h"

#include <array>
#include <cstddef>
#include <span>

namespace penumbra {

/// The bounds of `scene`; when they are empty or a point, a box of side 2 where something would be:
/// around that point, standing on the first plane, or around the origin.
Bounds stage(const Scene& scene);

/// For each direction d, of any length, the largest p . d of all points p of facets and spheres;
/// of the box stage() where there are none. Of meshes that are shown very often it is that of
/// their boxes.
void reaches(const Scene& scene, std::span<const Vec3> directions, std::span<double> farthest);

template <std::size_t n>
std::array<double, n> reaches(const Scene& scene, const std::array<Vec3, n>& directions) {
    std::array<double, n> farthest;
    reaches(scene, directions, farthest);
    return farthest;
}

}  // namespace penumbra
