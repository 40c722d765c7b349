// What tells whether two facets of one plane must be parted.
#pragma once

#include "prepare/surfaces/world_facets.h"

namespace penumbra {

/// One of two that lie in one plane.
struct Side {
    Index instance = no_index;  ///< none: a plane of the scene
    Index material = 0;
    bool plain = false;  ///< looks like any other of its material
    bool opaque = true;
    bool solid = true;  ///< only its front is seen
    bool one_sided = false;
};

Side side_of(const WorldFacets& facets, Index number);

/// Does it make a difference which of the two is seen?
bool must_be_parted(const Side& a, const Side& b, bool facing);

}  // namespace penumbra
