#include "blockers.h"

#include <algorithm>
#include <cmath>

namespace penumbra {

namespace {

constexpr std::size_t most_boxes = 1 << 16;
constexpr std::size_t least_facets = 16;  // in one box
constexpr double padding = 1e-5;          // float32 rounding of a normalised scene's vertices

Bounds padded(Bounds box) {
    box.min -= Vec3(padding);
    box.max += Vec3(padding);
    return box;
}

Bounds box_of(const Sphere& sphere) {
    const Vec3 half(sphere.radius);
    return padded({.min = sphere.center - half, .max = sphere.center + half});
}

// Boxes around runs of `run` facets in the mesh's own space: neighbours in a file are mostly
// neighbours in space.
std::vector<Bounds> runs_of(const Mesh& mesh, std::size_t run) {
    std::vector<Bounds> boxes;
    for (std::size_t first = 0; first < mesh.triangles.size(); first += run) {
        Bounds& box = boxes.emplace_back();
        const std::size_t end = std::min(first + run, mesh.triangles.size());
        for (std::size_t f = first; f < end; ++f)
            for (const Index corner : mesh.triangles[f]) box.extend(Vec3(mesh.positions[corner]));
    }
    return boxes;
}

// The range of n . p over a box.
std::pair<double, double> extent_along(const Bounds& box, const Vec3& n) {
    const Vec3 center = box.center(), half = (box.max - box.min) * 0.5;
    const double middle = n.dot(center);
    const double reach = std::abs(n.x) * half.x + std::abs(n.y) * half.y + std::abs(n.z) * half.z;
    return {middle - reach, middle + reach};
}

// Do all segments between the boxes stay on one side of the plane (or start on it)?
bool plane_between(const PreparedPlane& plane, const Bounds& from, const Bounds& to) {
    const auto [low, high] = extent_along(from, plane.frame.normal);
    const auto [source_low, source_high] = extent_along(to, plane.frame.normal);
    constexpr double on_it = 1e-9;
    const bool above = low >= plane.distance - on_it && source_low > plane.distance;
    const bool below = high <= plane.distance + on_it && source_high < plane.distance;
    return !above && !below;
}

}  // namespace

BoxTree boxes_of_facets(const Scene& scene) {
    const std::size_t run = std::max(least_facets, facet_count(scene) / most_boxes);
    std::vector<std::vector<Bounds>> runs(scene.meshes.size());
    std::vector<BoxedItem> items;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (runs[instance.mesh].empty()) runs[instance.mesh] = runs_of(mesh, run);
        for (const Bounds& box : runs[instance.mesh])
            items.push_back({.box = padded(transformed(box, instance.transform))});
    }
    return make_box_tree(std::move(items));
}

BoxTree boxes_of_spheres(const Scene& scene) {
    std::vector<BoxedItem> items;
    auto object = Index(scene.instances.size());
    for (const Sphere& sphere : scene.spheres)
        items.push_back({.box = box_of(sphere), .item = object++});
    return make_box_tree(std::move(items));
}

void Blockers::find_group(const World& world, const Bounds& box, const Bounds& light, bool facets) {
    BlockedBy& group = groups.emplace_back();
    group.first_shape = shapes.size();
    const Shaft shaft = make_shaft(box, light);
    const auto in_shaft = [&](const Bounds& other) { return touches(shaft, other); };
    const auto add = [&](Index object) {
        group.any = true;
        if (world.finish_of(object).opaque) shapes.push_back(object);
    };
    for (const Index sphere : spheres_)
        if (in_shaft(box_of(world.sphere(sphere)))) add(sphere);
    for (const Index plane : planes_)
        if (plane_between(world.plane(plane), box, light)) add(plane);
    group.last_shape = shapes.size();
    group.facets = facets && visit_boxes(world.facet_boxes, in_shaft, [](Index) { return true; });
    group.any |= group.facets;
}

bool Blockers::find(const World& world, const Bounds& all, std::span<const Bounds> boxes,
                    const Bounds& light) {
    groups.clear();
    shapes.clear();
    spheres_.clear();
    planes_.clear();
    const Shaft shaft = make_shaft(all, light);
    const auto in_shaft = [&](const Bounds& box) { return touches(shaft, box); };
    visit_boxes(world.sphere_boxes, in_shaft, [&](Index sphere) {
        spheres_.push_back(sphere);
        return false;
    });
    for (std::size_t i = 0; i < world.planes.size(); ++i)
        if (plane_between(world.planes[i], all, light))
            planes_.push_back(world.first_plane() + Index(i));
    const bool facets = visit_boxes(world.facet_boxes, in_shaft, [](Index) { return true; });
    if (!facets && spheres_.empty() && planes_.empty()) return false;
    for (const Bounds& box : boxes) find_group(world, box, light, facets);
    return std::any_of(groups.begin(), groups.end(),
                       [](const BlockedBy& group) { return group.any; });
}

}  // namespace penumbra
