#include "blockers.h"

#include <tbb/parallel_for.h>

#include <algorithm>

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
    const std::size_t count = mesh.triangles.size();
    std::vector<Bounds> boxes((count + run - 1) / run);
    tbb::parallel_for(std::size_t(0), boxes.size(), [&](std::size_t i) {
        for (std::size_t f = i * run; f < std::min((i + 1) * run, count); ++f)
            for (const Index corner : mesh.triangles[f])
                boxes[i].extend(Vec3(mesh.positions[corner]));
    });
    return boxes;
}

// Do segments between points and sources on those sides of the plane, or some of them, cross it?
// Points may lie on it.
bool plane_between(const PreparedPlane& plane, const Extent& points, const Extent& sources) {
    constexpr double on_it = 1e-9;
    const bool above = points.low >= plane.distance - on_it && sources.low > plane.distance;
    const bool below = points.high <= plane.distance + on_it && sources.high < plane.distance;
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

void PointGroups::clear() {
    all = {};
    boxes.clear();
    along.clear();
}

void PointGroups::add(const World& world, const Vectors& positions, const IndexRange& range) {
    boxes.push_back(box_around(positions, range));
    all.extend(boxes.back().min);
    all.extend(boxes.back().max);
    const Lanes p(positions);
    scratch_.resize(range.last - range.first);
    for (const PreparedPlane& plane : world.planes) {
        const Vec3& n = plane.frame.normal;
        for (std::size_t i = range.first; i < range.last; ++i)
            scratch_[i - range.first] = n.x * p.x[i] + n.y * p.y[i] + n.z * p.z[i];
        along.push_back(extent_of(scratch_.data(), {0, scratch_.size()}));
    }
}

void Blockers::find_group(const World& world, const PointGroups& points, const SourceGroup& light,
                          bool facets) {
    const std::size_t index = groups.size();
    BlockedBy& group = groups.emplace_back();
    group.first_shape = shapes.size();
    const auto add = [&](Index object) {
        group.any = true;
        if (world.finish_of(object).opaque) shapes.push_back(object);
    };
    for (std::size_t k = 0; k < world.planes.size(); ++k)
        if (plane_between(world.planes[k], points.along[index * world.planes.size() + k],
                          light.along[k]))
            add(world.first_plane() + Index(k));
    if (facets || !spheres_.empty()) {
        const Shaft shaft = make_shaft(points.boxes[index], light.box);
        const auto in_shaft = [&](const Bounds& box) { return touches(shaft, box); };
        const Capsule capsule = make_capsule(points.boxes[index], light.box);
        for (const Index object : spheres_) {
            const Sphere& sphere = world.sphere(object);
            if (in_shaft(box_of(sphere)) && touches(capsule, sphere.center, sphere.radius))
                add(object);
        }
        group.facets =
            facets && visit_boxes(world.facet_boxes, in_shaft, [](Index) { return true; });
    }
    group.last_shape = shapes.size();
    group.any |= group.facets;
}

void Blockers::find(const World& world, const PointGroups& points, const SourceGroup& light) {
    groups.clear();
    shapes.clear();
    spheres_.clear();
    const Shaft shaft = make_shaft(points.all, light.box);
    const auto in_shaft = [&](const Bounds& box) { return touches(shaft, box); };
    visit_boxes(world.sphere_boxes, in_shaft, [&](Index sphere) {
        spheres_.push_back(sphere);
        return false;
    });
    const bool facets = visit_boxes(world.facet_boxes, in_shaft, [](Index) { return true; });
    for (std::size_t i = 0; i < points.boxes.size(); ++i) find_group(world, points, light, facets);
}

}  // namespace penumbra
