#include "tracer/accel/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <span>

namespace penumbra {

namespace {

constexpr std::size_t worth_a_task = 4096;  // items

// Makes node `self` and all below it: splits the items at the median of the longest axis of their
// boxes' centres. A tree of n items has 2 n - 1 nodes.
void build(BoxTree& tree, std::size_t self, std::span<BoxedItem> items) {
    Bounds all, centers;
    for (const BoxedItem& item : items) {
        all.extend(item.box.min);
        all.extend(item.box.max);
        centers.extend(item.box.center());
    }
    tree.nodes[self].box = all;
    if (items.size() == 1) {
        tree.nodes[self].item = items[0].item;
        return;
    }
    const Vec3 size = centers.max - centers.min;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(half), items.end(),
                     [axis](const BoxedItem& a, const BoxedItem& b) {
                         return a.box.min[axis] + a.box.max[axis] <
                                b.box.min[axis] + b.box.max[axis];
                     });
    const std::size_t right = self + 2 * half;
    tree.nodes[self].right = Index(right);
    const auto first = [&] { build(tree, self + 1, items.first(half)); };
    const auto second = [&] { build(tree, right, items.subspan(half)); };
    if (items.size() >= worth_a_task) return tbb::parallel_invoke(first, second);
    first();
    second();
}

}  // namespace

BoxTree make_box_tree(std::vector<BoxedItem> items) {
    BoxTree tree;
    if (items.empty()) return tree;
    tree.nodes.resize(2 * items.size() - 1);
    build(tree, 0, items);
    return tree;
}

}  // namespace penumbra
