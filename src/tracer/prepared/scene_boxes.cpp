#include "tracer/prepared/scene_boxes.h"

#include "scene/tolerances.h"
#include "scene/transforms.h"

#include "penumbra/scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::size_t most_boxes = 1 << 16;
constexpr std::size_t least_facets = 16;  // in one box
constexpr double padding = 10 * coordinate_rounding;

Bounds padded(Bounds box) {
    box.min -= Vec3(padding);
    box.max += Vec3(padding);
    return box;
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

}  // namespace

Bounds box_of(const Sphere& sphere) {
    const Vec3 half(sphere.radius);
    return padded({.min = sphere.center - half, .max = sphere.center + half});
}

namespace {

template <class Counts>
BoxTree boxes_of(const Scene& scene, const Counts& counts) {
    const std::size_t run = std::max(least_facets, facet_count(scene) / most_boxes);
    std::vector<std::vector<Bounds>> runs(scene.meshes.size());
    std::vector<BoxedItem> items;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (!counts(mesh)) continue;
        if (runs[instance.mesh].empty()) runs[instance.mesh] = runs_of(mesh, run);
        for (const Bounds& box : runs[instance.mesh])
            items.push_back({.box = padded(transformed(box, instance.transform))});
    }
    return make_box_tree(std::move(items));
}

}  // namespace

BoxTree boxes_of_facets(const Scene& scene) {
    return boxes_of(scene, [](const Mesh&) { return true; });
}

BoxTree boxes_of_translucent_facets(const Scene& scene) {
    return boxes_of(scene,
                    [&](const Mesh& mesh) { return !opaque(scene.materials[mesh.material]); });
}

BoxTree boxes_of_spheres(const Scene& scene) {
    std::vector<BoxedItem> items;
    auto object = Index(scene.instances.size());
    for (const Sphere& sphere : scene.spheres)
        items.push_back({.box = box_of(sphere), .item = object++});
    return make_box_tree(std::move(items));
}

}  // namespace penumbra
