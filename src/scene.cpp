#include "penumbra/scene.h"

#include "box_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra {

void Bounds::extend(const Vec3& p) {
    for (int axis = 0; axis < 3; ++axis) {
        min[axis] = std::min(min[axis], p[axis]);
        max[axis] = std::max(max[axis], p[axis]);
    }
}

namespace {

// The vertices that facets use, and the box around them: a file may hold others.
struct Corners {
    std::vector<bool> used = {};
    Bounds box = {};

    explicit Corners(const Mesh& mesh) : used(mesh.positions.size(), false) {
        for (const auto& triangle : mesh.triangles)
            for (const Index corner : triangle) used[corner] = true;
        for (std::size_t i = 0; i < used.size(); ++i)
            if (used[i]) box.extend(Vec3(mesh.positions[i]));
    }
};

bool contains(const Bounds& box, const Bounds& other) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(other.min[axis] >= box.min[axis] && other.max[axis] <= box.max[axis])) return false;
    return true;
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
        const Corners& known = *corners[instance.mesh];
        for (std::size_t i = 0; i < known.used.size(); ++i)
            if (known.used[i]) box.extend(Vec3(mesh.positions[i]) * instance.transform);
    }
    for (const Sphere& sphere : scene.spheres) {
        box.extend(sphere.center - Vec3(sphere.radius));
        box.extend(sphere.center + Vec3(sphere.radius));
    }
    return box;
}

std::size_t facet_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

Vec2 sphere_texcoord(const Vec3& p) {
    // POV-Ray's sphere uv_mapping, mirrored by `scale <-1, 1, 1>`.
    const double turn = -std::atan2(p.z, p.x) / (2 * std::numbers::pi);
    return {turn < 0 ? turn + 1 : turn,
            0.5 + std::asin(std::clamp(p.y, -1.0, 1.0)) / std::numbers::pi};
}

PlaneFrame plane_frame(const Plane& plane) {
    const Vec3 normal = plane.normal.normalized();
    // Up in the image is world up on a wall and away from the viewer (-z) on a floor or ceiling.
    const Vec3 up = std::abs(normal.y) > 0.99 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    const Vec3 u = up.cross(normal).normalized();
    return {.origin = plane.point, .normal = normal, .u = u, .v = normal.cross(u)};
}

View view_of(const Camera& camera, int width, int height) {
    const Vec3 forward = camera.direction.normalized();
    const Vec3 right = forward.cross(camera.up).normalized();
    const Vec3 up = right.cross(forward);
    const bool orthographic = camera.projection == Camera::Projection::orthographic;
    const double side = orthographic ? camera.extent : 2 * std::tan(camera.fov / 2);
    const double aspect = double(width) / height;
    const bool horizontal = camera.side == Camera::Side::horizontal;
    const double across = horizontal ? side : side * aspect;
    const double along = horizontal ? side / aspect : side;
    return {.orthographic = orthographic,
            .location = camera.position,
            .right = right * across,
            .up = up * along,
            .direction = forward};
}

Color fade_color(const Absorption& absorption) {
    const auto fade = [](float c) { return float(1 + std::log(double(std::max(c, 1e-6F)))); };
    return {fade(absorption.color.x), fade(absorption.color.y), fade(absorption.color.z)};
}

Vec3 fade_exponent(const Absorption& absorption) {
    return (Vec3(1) - Vec3(fade_color(absorption))) * (1 / double(float(absorption.distance)));
}

Vec2 sky_texcoord(const Vec3& d) {
    return {std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + 0.5,
            std::asin(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi + 0.5};
}

}  // namespace penumbra
