// Where the sphere stands that shows Scene::mirror_sky.
#pragma once

#include "penumbra/math.h"
#include "penumbra/scene.h"

namespace penumbra {

/// The middle of all facets and spheres: what is mirrored does not change with the scene's place.
inline Vec3 mirror_sky_center(const Scene& scene) {
    if (!scene.mirror_sky) return Vec3(0);
    const Bounds box = bounds(scene);
    return box.empty() ? Vec3(0) : box.center();
}

}  // namespace penumbra
