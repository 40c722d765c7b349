#include "prepare/surfaces/facet_overlaps.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

// Are all corners of one in the plane of the other?
bool in_plane_of(const WorldFacet& a, const WorldFacet& b, double tolerance) {
    return std::ranges::all_of(a.corners,
                               [&](const Vec3& p) { return std::abs(b.height(p)) <= tolerance; });
}

// Does an edge of `a` part the two, but for least_overlap?
bool parted_by_edges(const WorldFacet& a, const WorldFacet& b, const Vec3& winding) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& from = a.corners[i];
        const Vec3 outwards = (a.corners[(i + 1) % 3] - from).cross(winding);
        const double least = least_overlap * least_overlap * outwards.length2();
        const bool apart = std::ranges::all_of(b.corners, [&](const Vec3& p) {
            const double way = outwards.dot(p - from);
            return way > 0 || way * way <= least;
        });
        if (apart) return true;
    }
    return false;
}

Vec3 winding(const WorldFacet& f) {
    return (f.corners[1] - f.corners[0]).cross(f.corners[2] - f.corners[0]);
}

}  // namespace

// Convex polygons in a plane lie apart where an edge of one of them parts them.
bool overlap(const WorldFacet& a, const WorldFacet& b, double tolerance) {
    return (in_plane_of(a, b, tolerance) || in_plane_of(b, a, tolerance)) &&
           !parted_by_edges(a, b, winding(a)) && !parted_by_edges(b, a, winding(b));
}

// Where two overlap by less than least_overlap along some direction in their plane they do not
// count. Of an axis that leans to the plane only a part is in it.
GroupedBox boxed(const WorldFacet& facet, std::size_t item, Index group) {
    Bounds box;
    for (const Vec3& p : facet.corners) box.extend(p);
    for (int axis = 0; axis < 3; ++axis) {
        const double n = facet.normal[axis];
        const double in_plane = std::sqrt(std::max(0.0, 1 - n * n));
        const double by = in_one_plane - 0.5 * least_overlap * in_plane;
        box.min[axis] -= by;
        box.max[axis] += by;
    }
    return {box, Index(item), group};
}

namespace {

constexpr std::size_t in_a_leaf = 8;
constexpr Index several = no_index;  // groups

bool touch(const Bounds& a, const Bounds& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
    return true;
}

// Boxes [first, last), halved along the longest side of the box around their middles.
struct Node {
    Bounds box = {};
    std::size_t first = 0, last = 0;
    Index group = several;  // of all its boxes
    std::size_t left = 0, right = 0;
};

class PairTree {
  public:
    PairTree(std::vector<GroupedBox>& boxes, const std::function<void(Index, Index)>& visit)
        : boxes_(boxes), visit_(visit) {
        nodes_.reserve(boxes.size() / 2);
        if (!boxes.empty()) within(build(0, boxes.size()));
    }

  private:
    std::size_t build(std::size_t first, std::size_t last) {
        Node node = {.first = first, .last = last, .group = boxes_[first].group};
        Bounds middles;
        for (std::size_t i = first; i < last; ++i) {
            node.box.extend(boxes_[i].box.min);
            node.box.extend(boxes_[i].box.max);
            middles.extend(boxes_[i].box.center());
            if (boxes_[i].group != node.group) node.group = several;
        }
        if (last - first > in_a_leaf) {
            const Vec3 size = middles.max - middles.min;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const auto at = [&](std::size_t i) { return boxes_.begin() + std::ptrdiff_t(i); };
            const std::size_t middle = first + (last - first) / 2;
            std::nth_element(
                at(first), at(middle), at(last), [axis](const GroupedBox& a, const GroupedBox& b) {
                    return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
                });
            node.left = build(first, middle);
            node.right = build(middle, last);
        }
        nodes_.push_back(node);
        return nodes_.size() - 1;
    }

    bool is_leaf(const Node& node) const { return node.last - node.first <= in_a_leaf; }

    void offer(const GroupedBox& a, const GroupedBox& b) const {
        if (a.group != b.group && touch(a.box, b.box)) visit_(a.item, b.item);
    }

    void within(std::size_t index) const {
        const Node& node = nodes_[index];
        if (node.group != several) return;
        if (is_leaf(node)) {
            for (std::size_t i = node.first; i < node.last; ++i)
                for (std::size_t j = i + 1; j < node.last; ++j) offer(boxes_[i], boxes_[j]);
            return;
        }
        within(node.left);
        within(node.right);
        between(node.left, node.right);
    }

    void between(std::size_t first, std::size_t second) const {
        const Node &a = nodes_[first], &b = nodes_[second];
        if (!touch(a.box, b.box) || (a.group != several && a.group == b.group)) return;
        if (is_leaf(a) && is_leaf(b)) {
            for (std::size_t i = a.first; i < a.last; ++i)
                for (std::size_t j = b.first; j < b.last; ++j) offer(boxes_[i], boxes_[j]);
        } else if (is_leaf(b) || (!is_leaf(a) && a.last - a.first >= b.last - b.first)) {
            between(a.left, second);
            between(a.right, second);
        } else {
            between(first, b.left);
            between(first, b.right);
        }
    }

    std::vector<GroupedBox>& boxes_;
    const std::function<void(Index, Index)>& visit_;
    std::vector<Node> nodes_;
};

}  // namespace

void each_touching_pair(std::vector<GroupedBox>& boxes,
                        const std::function<void(Index, Index)>& visit) {
    const PairTree tree(boxes, visit);
}

}  // namespace penumbra
