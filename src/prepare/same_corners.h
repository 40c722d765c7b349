// Facets of instances that have the same corners in the world.
#pragma once

#include "scene/transforms.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace penumbra {

/// A facet of an instance, by a hash of its corners in the world whatever their order.
struct Placed {
    std::uint64_t hash = 0;
    Index instance = 0, facet = 0;
};

/// A scene, and where its positions are counted from: in float32, in which neighbours are the same
/// place, they must not be far away.
struct LocalPositions {
    const Scene& scene;
    Vec3 origin = local_origin(bounds(scene));

    Vec3f place(const Vec3f& p, const Instance& instance) const {
        return Vec3f(Vec3(p) * instance.transform - origin);
    }
};

/// Facets of the instances of which there may be several with the same corners, most likely all of
/// them; sorted, so that these follow one another, those of the first instance first.
std::vector<Placed> suspects(const LocalPositions& local, const std::vector<Index>& instances);

/// False where nothing is to be done by lift_back_to_back_facets() and drop_coincident_facets().
bool may_coincide(const Scene& scene);

/// In the order of the mesh.
std::array<Vec3f, 3> corners(const LocalPositions& local, const Placed& placed);

/// In whatever order.
bool same_corners(std::array<Vec3f, 3> a, std::array<Vec3f, 3> b);

}  // namespace penumbra
