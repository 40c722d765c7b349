// How large a scene is.
#include "scene/defects.h"
#include "scene/transforms.h"

#include "penumbra/scene.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

namespace penumbra {

void Bounds::extend(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], p[axis]);
        max[axis] = std::max(max[axis], p[axis]);
    }
}

Bounds box_around(std::span<const Vec3f> points, std::span<const char> chosen) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3f low(infinity), high(-infinity);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!chosen.empty() && chosen[i] == 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], points[i][axis]);
            high[axis] = std::max(high[axis], points[i][axis]);
        }
    }
    return low.x <= high.x ? Bounds{.min = Vec3(low), .max = Vec3(high)} : Bounds{};
}

namespace {

// The vertices that facets use, and the box around them: a file may hold others.
struct Corners {
    std::vector<char> used = {};
    Bounds box = {};

    explicit Corners(const Mesh& mesh) : used(mesh.positions.size(), 0) {
        for (const auto& triangle : mesh.triangles)
            for (const Index corner : triangle) used[corner] = 1;
        box = box_around(mesh.positions, used);
    }
};

}  // namespace

Bounds box_around_facets(const Mesh& mesh) {
    assert(indices_in_range(mesh));
    return Corners(mesh).box;
}

namespace {

// Is a box that is transformed as tight as the box around what is transformed?
bool keeps_axes(const Matrix& m) {
    return m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 &&
           m[2][1] == 0;
}

bool contains(const Bounds& box, const Bounds& other) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(other.min[axis] >= box.min[axis] && other.max[axis] <= box.max[axis])) return false;
    return true;
}

// Around the vertices that facets use, where an instance shows them.
Bounds tight_box(const Mesh& mesh, const std::vector<char>& used, const Matrix& transform) {
    Vec3 low = Bounds().min, high = Bounds().max;  // in registers
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (used[i] == 0) continue;
        const Vec3 p = moved(mesh.positions[i], transform);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return {.min = low, .max = high};
}

// The instances that reach furthest along the axes, by the boxes around them, then all.
std::vector<std::size_t> far_ones_first(const std::vector<Bounds>& boxes) {
    std::vector<std::size_t> order;
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = std::ranges::min_element(boxes, {}, [&](auto& b) { return b.min[axis]; });
        const auto high = std::ranges::max_element(boxes, {}, [&](auto& b) { return b.max[axis]; });
        if (low != boxes.end()) order.push_back(std::size_t(low - boxes.begin()));
        if (high != boxes.end()) order.push_back(std::size_t(high - boxes.begin()));
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) order.push_back(i);
    return order;
}

}  // namespace

Bounds bounds(const Scene& scene) {
    assert(indices_in_range(scene));
    std::vector<std::optional<Corners>> corners(scene.meshes.size());
    std::vector<Bounds> boxes;  // around the instances, not tight
    for (const Instance& instance : scene.instances) {
        auto& known = corners[instance.mesh];
        if (!known) known.emplace(scene.meshes[instance.mesh]);
        const bool empty = scene.meshes[instance.mesh].triangles.empty();
        boxes.push_back(empty ? Bounds() : transformed(known->box, instance.transform));
    }
    Bounds box;
    for (const std::size_t index : far_ones_first(boxes)) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (mesh.triangles.empty() || contains(box, boxes[index])) continue;
        const Bounds around =
            keeps_axes(instance.transform)
                ? boxes[index]
                : tight_box(mesh, corners[instance.mesh]->used, instance.transform);
        if (around.empty()) continue;
        box.extend(around.min);
        box.extend(around.max);
    }
    for (const Sphere& sphere : scene.spheres) {
        box.extend(sphere.center - Vec3(sphere.radius));
        box.extend(sphere.center + Vec3(sphere.radius));
    }
    return box;
}

std::size_t facet_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) {
        assert(instance.mesh < scene.meshes.size());
        count += scene.meshes[instance.mesh].triangles.size();
    }
    return count;
}

Vec3 local_origin(const Bounds& box) {
    const bool far = !box.empty() && box.center().length() > far_away * box.radius();
    return far ? box.center() : Vec3(0);
}

Bounds transformed(const Bounds& box, const Matrix& transform) {
    const Vec3 move(transform[3][0], transform[3][1], transform[3][2]);
    Bounds result = {.min = move, .max = move};
    for (int to = 0; to < 3; ++to)
        for (int from = 0; from < 3; ++from) {
            const double a = box.min[from] * transform[from][to];
            const double b = box.max[from] * transform[from][to];
            result.min[to] += std::min(a, b);
            result.max[to] += std::max(a, b);
        }
    return result;
}

}  // namespace penumbra
