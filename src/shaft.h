// Is there anything between a group of surface points and a light?
#pragma once

#include "penumbra/scene.h"

#include <span>

namespace penumbra {

/// Boxes around groups of facets and around spheres, in a tree. Planes are not in it.
struct BlockerTree {
    struct Node {
        Bounds box;
        Index right = 0;  ///< the second child; the first follows its parent. 0: a leaf
    };
    std::vector<Node> nodes = {};
};

BlockerTree make_blocker_tree(const Scene& scene);

/// False only when no facet and no sphere touches the convex hull of the two boxes: then nothing
/// but a plane can block a segment from one to the other. After Haines and Wallace 1991, "Shaft
/// Culling for Efficient Ray-Traced Radiosity".
bool may_block(const BlockerTree& tree, const Bounds& from, const Bounds& to);

}  // namespace penumbra
