// Moves facets of a mesh off the plane that they lie in.
#pragma once

#include "penumbra/scene.h"

#include <vector>

namespace penumbra {

/// A facet in one plane with others. It goes to the given level above the plane, on the side of its
/// front or, turned, of its back; below it where that is negative. On level 0 it stays.
struct LevelledFacet {
    Index facet = 0;
    double level = 0;
    bool turned = false;
    bool torn = false;  ///< what shares its corners does not go along: it has vertices of its own
    auto operator<=>(const LevelledFacet&) const = default;
};

/// Moves facets of the instance's mesh, sorted by number, to their levels, which are `step` apart
/// in the world. What shares their corners without lying beneath them stays joined to them.
void lift(Mesh& mesh, const Matrix& transform, const std::vector<LevelledFacet>& facets,
          double step);

}  // namespace penumbra
