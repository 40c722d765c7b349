// What the losses of surfaces that a camera is near to have in common.
#pragma once

#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace penumbra {

/// 0 within the box.
inline double distance(const Vec3& from, const Bounds& box) {
    Vec3 way(0);
    for (int axis = 0; axis < 3; ++axis)
        way[axis] = std::max({box.min[axis] - from[axis], 0.0, from[axis] - box.max[axis]});
    return way.length();
}

/// An instance as a message names it: by its mesh or its number where it has no name.
inline std::string described(const Scene& scene, Index instance) {
    const Instance& i = scene.instances[instance];
    const std::string& name = i.name.empty() ? scene.meshes[i.mesh].name : i.name;
    return name.empty() ? fmt::format("object {}", instance + 1) : "'" + name + "'";
}

}  // namespace penumbra
