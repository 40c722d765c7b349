// How far above the plane that they share patches go that lie on one another.
#pragma once

#include "prepare/surfaces/coplanar_patches.h"
#include "prepare/surfaces/world_facets.h"

#include <unordered_map>
#include <vector>

namespace penumbra {

struct PatchPlace {
    double level = 0;     ///< layers above the plane, on the side of the patch's front
    bool turned = false;  ///< of its back instead
    bool torn = false;    ///< from the body that it is a side of, and goes into
};
using PatchPlaces = std::unordered_map<Index, PatchPlace>;

/// Each patch goes above all that it lies on, in the order of the file. Where that would lift by
/// far the largest one of a plane, and with it all that stands on it, the others go down instead.
PatchPlaces places_of(const WorldFacets& facets, const CoplanarPatches& found);

}  // namespace penumbra
