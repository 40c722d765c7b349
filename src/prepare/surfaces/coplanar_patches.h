// Patches: facets of an instance that hang together in one plane; and which of them lie on others.
#pragma once

#include "prepare/surfaces/folded_patches.h"
#include "prepare/surfaces/world_facets.h"

#include <vector>

namespace penumbra {

/// One patch lies on another, or on a plane of the scene. Patches are called by their first facet.
struct OverlappingPatches {
    Index lower = no_index;  ///< no_index: a plane of the scene
    Index upper = 0;
    bool facing = true;  ///< their fronts are on one side
    bool turned = false; /**< the upper one lies on the lower one's front, whichever way it faces */
    auto operator<=>(const OverlappingPatches&) const = default;
};

struct CoplanarPatches {
    std::vector<Index> patch = {};  ///< of every facet; maybe empty where nothing overlaps
    std::vector<OverlappingPatches> overlaps = {};
    std::vector<TornFacet> torn = {};  ///< from patches that overlap themselves
    bool left = false;                 ///< some still do: they would be too many
};

/// Finds the patches that have to be parted, as it makes a difference which of them is seen.
CoplanarPatches coplanar_patches(const WorldFacets& facets);

/// Does one instance lie on another where both are in one plane? As viewers draw them: what is
/// blended after all the rest, and else in the order of the file.
bool lies_on(const WorldFacets& facets, Index instance, Index other);

}  // namespace penumbra
