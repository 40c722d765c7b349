#include "shaft.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr std::size_t most_boxes = 1 << 16;
constexpr std::size_t least_facets = 16;  // in one box
constexpr double padding = 1e-5;          // float32 rounding of a normalised scene's vertices

// ---- the tree ----------------------------------------------------------------------------------

// Boxes around runs of `run` facets: neighbours in a file are mostly neighbours in space.
void add_facet_boxes(const Scene& scene, std::size_t run, std::vector<Bounds>& boxes) {
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        const bool identity = instance.transform == Matrix();
        for (std::size_t first = 0; first < mesh.triangles.size(); first += run) {
            Bounds box;
            const std::size_t end = std::min(first + run, mesh.triangles.size());
            for (std::size_t f = first; f < end; ++f)
                for (const Index corner : mesh.triangles[f]) {
                    const Vec3 p(mesh.positions[corner]);
                    box.extend(identity ? p : p * instance.transform);
                }
            boxes.push_back(box);
        }
    }
}

// Splits boxes[first, last) at the median of the longest axis of their centres.
void build(BlockerTree& tree, std::span<Bounds> boxes) {
    const std::size_t self = tree.nodes.size();
    tree.nodes.emplace_back();
    Bounds all, centers;
    for (const Bounds& box : boxes) {
        all.extend(box.min);
        all.extend(box.max);
        centers.extend(box.center());
    }
    tree.nodes[self].box = all;
    if (boxes.size() == 1) return;
    const Vec3 size = centers.max - centers.min;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const std::size_t half = boxes.size() / 2;
    std::nth_element(boxes.begin(), boxes.begin() + std::ptrdiff_t(half), boxes.end(),
                     [axis](const Bounds& a, const Bounds& b) {
                         return a.min[axis] + a.max[axis] < b.min[axis] + b.max[axis];
                     });
    build(tree, boxes.first(half));
    tree.nodes[self].right = Index(tree.nodes.size());
    build(tree, boxes.subspan(half));
}

// ---- the shaft ---------------------------------------------------------------------------------

// A plane parallel to one axis that touches both boxes on their outside; points of the shaft have
// weight_a p[a] + weight_b p[b] <= limit.
struct Side {
    int a = 0, b = 0;
    double weight_a = 0, weight_b = 0, limit = 0;
};

struct Shaft {
    Bounds hull;
    std::array<Side, 12> sides = {};
    int count = 0;
};

// In each of the three projections the hull of two rectangles has slanted edges that join corners
// of the same kind (such as both lower left ones), where the edge's normal points that way.
Shaft make_shaft(const Bounds& from, const Bounds& to) {
    Shaft shaft = {.hull = from};
    shaft.hull.extend(to.min);
    shaft.hull.extend(to.max);
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
        for (const bool high_a : {false, true}) {
            for (const bool high_b : {false, true}) {
                const auto corner = [&](const Bounds& box) {
                    return Vec2(high_a ? box.max[a] : box.min[a], high_b ? box.max[b] : box.min[b]);
                };
                const Vec2 start = corner(from), edge = corner(to) - start;
                Vec2 normal(edge.y, -edge.x);
                if ((normal.x > 0) != high_a) normal = -normal;
                const bool outward = normal.x != 0 && normal.y != 0 && (normal.x > 0) == high_a &&
                                     (normal.y > 0) == high_b;
                if (!outward) continue;
                normal /= std::sqrt(normal.dot(normal));
                shaft.sides[std::size_t(shaft.count++)] = {a, b, normal.x, normal.y,
                                                           normal.dot(start)};
            }
        }
    }
    return shaft;
}

bool touches(const Shaft& shaft, const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.min[axis] > shaft.hull.max[axis] || box.max[axis] < shaft.hull.min[axis])
            return false;
    for (int i = 0; i < shaft.count; ++i) {
        const Side& side = shaft.sides[std::size_t(i)];
        // The box's corner that lies deepest inside.
        const double a = side.weight_a > 0 ? box.min[side.a] : box.max[side.a];
        const double b = side.weight_b > 0 ? box.min[side.b] : box.max[side.b];
        if (side.weight_a * a + side.weight_b * b > side.limit) return false;
    }
    return true;
}

}  // namespace

BlockerTree make_blocker_tree(const Scene& scene) {
    std::vector<Bounds> boxes;
    add_facet_boxes(scene, std::max(least_facets, facet_count(scene) / most_boxes), boxes);
    for (const Sphere& sphere : scene.spheres) {
        Bounds box;
        box.extend(sphere.center - Vec3(sphere.radius));
        box.extend(sphere.center + Vec3(sphere.radius));
        boxes.push_back(box);
    }
    for (Bounds& box : boxes) {
        box.min -= Vec3(padding);
        box.max += Vec3(padding);
    }
    BlockerTree tree;
    tree.nodes.reserve(2 * boxes.size());
    if (!boxes.empty()) build(tree, boxes);
    return tree;
}

bool may_block(const BlockerTree& tree, const Bounds& from, const Bounds& to) {
    if (tree.nodes.empty() || from.empty()) return false;
    const Shaft shaft = make_shaft(from, to);
    std::array<Index, 64> waiting{};
    std::size_t depth = 0;
    for (Index node = 0;;) {
        if (touches(shaft, tree.nodes[node].box)) {
            const Index right = tree.nodes[node].right;
            if (right == 0) return true;
            waiting[depth++] = right;
            ++node;
        } else {
            if (depth == 0) return false;
            node = waiting[--depth];
        }
    }
}

}  // namespace penumbra
