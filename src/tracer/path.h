// Rays on their way from the eye.
#pragma once

#include "tracer/accel/rays.h"
#include "tracer/media_stack.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace penumbra {

/// What a ray carries along its path.
struct Path {
    Vec3 weight = Vec3(1);  ///< of its light in the pixel
    std::uint32_t pixel = 0;
    int level = 1;  ///< ray segments so far, this one included; going straight through adds none
    MediumStack inside = {};
    bool mirrored = false;  ///< at least once: it sees what stands in mirrors only
};

/// Rays with their paths.
struct Generation {
    Rays rays;
    std::vector<Path> paths;

    explicit Generation(std::size_t capacity = 0) : rays(capacity), paths(capacity) {}
    void clear() { rays.count = 0; }
    void push(const Vec3& origin, const Vec3& direction, const Path& path);
};

inline void Generation::push(const Vec3& origin, const Vec3& direction, const Path& path) {
    const std::size_t i = rays.count++;
    if (i >= paths.size()) {
        const std::size_t capacity = std::max<std::size_t>(64, 2 * i);
        rays.origin.resize(capacity);
        rays.direction.resize(capacity);
        paths.resize(capacity);
    }
    rays.origin.set(i, origin);
    rays.direction.set(i, direction);
    paths[i] = path;
}

}  // namespace penumbra
