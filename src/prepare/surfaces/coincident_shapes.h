// Spheres and planes in the same place.
#pragma once

#include "penumbra/scene.h"

#include <cstddef>

namespace penumbra {

struct PartedShapes {
    std::size_t dropped = 0;  ///< opaque ones in the place of others
    std::size_t moved = 0;    ///< others: larger spheres, planes above one another
};

/// Leaves no two of them in one place: distances are `step` times their number. `factor` is that of
/// normalise().
PartedShapes part_coincident_shapes(Scene& scene, double step, double factor);

}  // namespace penumbra
