// The rays that a surface sends on: mirrored, refracted, or straight through.
#pragma once

#include "surface.h"

namespace penumbra {

/// What a ray carries along its path.
struct Path {
    Vec3 weight = Vec3(1);  ///< of its light in the pixel
    std::uint32_t pixel = 0;
    int level = 1;  ///< ray segments so far, this one included; going straight through adds none
    Interiors inside = {};
};

/// Rays with their paths.
struct Generation {
    Rays rays;
    std::vector<Path> paths;

    explicit Generation(std::size_t capacity = 0) : rays(capacity), paths(capacity) {}
    void clear() { rays.count = 0; }
    void push(const Vec3& origin, const Vec3& direction, const Path& path);
};

/// Pushes the rays that surface point `slot`, reached by `path`, sends on.
void scatter(const World& world, const Surfaces& surfaces, std::size_t slot, const Path& path,
             int max_depth, Generation& next);

/// The objects around the point `eye` where rays start.
Interiors interiors_at(const World& world, const Vec3& eye);

}  // namespace penumbra
