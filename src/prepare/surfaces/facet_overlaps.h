// Which facets of one plane lie on one another.
#pragma once

#include "prepare/surfaces/world_facets.h"

#include <functional>
#include <vector>

namespace penumbra {

/// Do two facets lie in one plane, but for a tolerance, and share more of it than an edge?
bool overlap(const WorldFacet& a, const WorldFacet& b, double tolerance = in_one_plane);

/// A box, and which of many it is.
struct GroupedBox {
    Bounds box = {};
    Index item = 0, group = 0;
};

/// Touches those of all facets that overlap the facet.
GroupedBox boxed(const WorldFacet& facet, std::size_t item, Index group);

/// Calls visit(item, item) once for every two boxes of different groups that touch. Changes the
/// order of the boxes.
void each_touching_pair(std::vector<GroupedBox>& boxes,
                        const std::function<void(Index, Index)>& visit);

}  // namespace penumbra
