#include "prepare/body.h"

#include "base/hash.h"
#include "prepare/weld.h"
#include "scene/defects.h"
#include "scene/sides.h"
#include "scene/transforms.h"

#include "penumbra/scene.h"

#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

// Different for (a, b) and (b, a).
std::uint64_t hash_of_edge(std::uint64_t a, std::uint64_t b) {
    const std::array ends = {a, b};
    return hash_of(std::as_bytes(std::span(ends)));
}

// Vertices by their places, to a millionth of the mesh: seams are closed but for rounding.
std::vector<std::uint64_t> places_of(const Mesh& mesh) {
    Bounds box;
    for (const Vec3f& p : mesh.positions) box.extend(Vec3(p));
    const double scale = box.radius() > 0 ? 1e6 / box.radius() : 0;
    std::vector<std::uint64_t> places;
    places.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) {
        const Vec3 at = (Vec3(p) - box.min) * scale;
        places.push_back(hash_of_point(
            {float(std::round(at.x)), float(std::round(at.y)), float(std::round(at.z))}));
    }
    return places;
}

}  // namespace

// Every edge then runs as often one way as the other, so that a sum over the hashes of both ways
// is 0, and the volume is positive (the sum of the tetrahedra between one point and the facets).
bool bounds_body(const Mesh& mesh) {
    assert(indices_in_range(mesh));
    const std::vector<std::uint64_t> places = places_of(mesh);
    std::uint64_t open = 0;
    double volume = 0;
    const Vec3 apex = mesh.positions.empty() ? Vec3(0) : Vec3(mesh.positions[0]);
    for (const auto& [a, b, c] : mesh.triangles) {
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            open += hash_of_edge(places[from], places[to]) - hash_of_edge(places[to], places[from]);
        volume += (Vec3(mesh.positions[a]) - apex)
                      .dot((Vec3(mesh.positions[b]) - apex).cross(Vec3(mesh.positions[c]) - apex));
    }
    return open == 0 && volume > 0;
}

namespace {

bool contains(const Bounds& box, const Vec3& point) {
    for (int axis = 0; axis < 3; ++axis)
        if (point[axis] < box.min[axis] || point[axis] > box.max[axis]) return false;
    return true;
}

}  // namespace

void show_whole_bodies(Scene& scene) {
    const std::vector<Backs> all = backs(scene);
    std::map<Index, Index> both;   // by material
    std::map<Index, bool> bodies;  // by mesh
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!all[i].hidden || all[i].from > 0 || all[i].lean == 0) continue;
        const Instance& instance = scene.instances[i];
        Mesh& mesh = scene.meshes[instance.mesh];
        if (scene.materials[mesh.material].sides == Sides::both) continue;  // by another instance
        const auto [body, unknown] = bodies.try_emplace(instance.mesh, false);
        if (unknown) body->second = opaque(scene.materials[mesh.material]) && bounds_body(mesh);
        const Bounds box = transformed(box_around_facets(mesh), instance.transform);
        const bool outside = scene.camera < scene.cameras.size() &&
                             !contains(box, scene.cameras[scene.camera].position);
        if (!body->second || !outside) continue;
        const auto [known, fresh] = both.try_emplace(mesh.material, Index(scene.materials.size()));
        if (fresh) {
            Material whole = scene.materials[mesh.material];
            whole.sides = Sides::both;
            scene.materials.push_back(std::move(whole));
        }
        mesh.material = known->second;
    }
}

}  // namespace penumbra
