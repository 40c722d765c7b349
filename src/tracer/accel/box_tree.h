// Boxes in a tree, so that a group of rays is asked about many of them at once.
#pragma once

#include "penumbra/scene.h"

#include <array>
#include <vector>

namespace penumbra {

struct BoxTree {
    struct Node {
        Bounds box;
        Index right = 0;        ///< the second child; the first follows its parent. 0: a leaf
        Index item = no_index;  ///< what the box of a leaf is around
    };
    std::vector<Node> nodes = {};
};

/// What the box of a leaf is around, by the number that it has for its owner.
struct BoxedItem {
    Bounds box;
    Index item = 0;
};

BoxTree make_box_tree(std::vector<BoxedItem> items);

/// Calls visit(item) for the leaves whose box and whose ancestors' boxes `touches` accepts, until
/// it returns true. Returns whether it has.
template <class Touches, class Visit>
bool visit_boxes(const BoxTree& tree, const Touches& touches, Visit visit) {
    if (tree.nodes.empty()) return false;
    std::array<Index, 64> waiting{};  // a median split is at most 32 levels deep
    std::size_t depth = 0;
    for (Index node = 0;;) {
        const BoxTree::Node& at = tree.nodes[node];
        if (touches(at.box)) {
            if (at.right != 0) {
                waiting[depth++] = at.right;
                ++node;
                continue;
            }
            if (visit(at.item)) return true;
        }
        if (depth == 0) return false;
        node = waiting[--depth];
    }
}

}  // namespace penumbra
