// What one-sided facets need before a scene can be shown: those that lie back to back, and a word
// about the backs that cannot be hidden.
#include "prepare/body.h"
#include "prepare/same_corners.h"
#include "prepare/scale.h"
#include "scene/defects.h"
#include "scene/sides.h"
#include "scene/tolerances.h"
#include "scene/transforms.h"
#include "scene/vertex_arrays.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace penumbra {

namespace {

// ---- back to back ------------------------------------------------------------------------------

bool before(const Vec3f& p, const Vec3f& q) {
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

// Sorts the corners. Returns whether an odd number of exchanges does that.
bool sort(std::array<Vec3f, 3>& corners) {
    bool odd = false;
    for (const auto& [a, b] : {std::pair(0U, 1U), std::pair(1U, 2U), std::pair(0U, 1U)}) {
        if (!before(corners[b], corners[a])) continue;
        std::swap(corners[a], corners[b]);
        odd = !odd;
    }
    return odd;
}

// Of facets with the same corners it is the same for those that are shown on one side.
bool turn_of(const LocalPositions& local, const Placed& placed) {
    auto places = corners(local, placed);
    return sort(places) != (local.scene.instances[placed.instance].transform.determinant() < 0);
}

// Those that show one side; of scenes with more than most_facets, only what is shown once.
std::vector<Index> one_sided_instances(const Scene& scene) {
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    const bool all = facet_count(scene) <= most_facets;
    std::vector<Index> found;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Index mesh = scene.instances[i].mesh;
        const bool one_sided = scene.materials[scene.meshes[mesh].material].sides == Sides::front;
        if (one_sided && (all || uses[mesh] == 1)) found.push_back(i);
    }
    return found;
}

// Moves facets along their normals, each with vertices of its own; `height` is in the world.
void lift(Mesh& mesh, const Matrix& to_world, const std::set<Index>& facets, double height) {
    std::vector<Index> chosen(mesh.positions.size());
    for (Index i = 0; i < chosen.size(); ++i) chosen[i] = i;
    for (const Index facet : facets)
        for (Index& corner : mesh.triangles[facet]) {
            chosen.push_back(corner);
            corner = Index(chosen.size() - 1);
        }
    choose_vertices(mesh, chosen);
    const Matrix normals = to_world.inverse().transposed();
    for (const Index facet : facets) {
        const auto& [a, b, c] = mesh.triangles[facet];
        const Vec3 first(mesh.positions[a]);
        const Vec3 up =
            (Vec3(mesh.positions[b]) - first).cross(Vec3(mesh.positions[c]) - first).normalized();
        // A way s up in the mesh leads s / |up'| away from the facet in the world, where up' is
        // `up` as normals are transformed.
        Vec3 in_world;
        normals.multDirMatrix(up, in_world);
        for (const Index corner : {a, b, c})
            mesh.positions[corner] =
                Vec3f(Vec3(mesh.positions[corner]) + up * (height * in_world.length()));
    }
}

// ---- backs that show ---------------------------------------------------------------------------

std::string what_shows(const Backs& backs) {
    const char* const why = "POV-Ray tells the sides of smooth facets by their normals";
    if (!backs.hidden) return fmt::format("the backs of its facets are shown: {}", why);
    const char* const what = backs.from > 0
                                 ? "its backs are shown where they are seen at less than"
                                 : "its fronts are left out where they are seen at less than";
    return fmt::format("{} {} degree{}: {}", what, backs.lean, backs.lean == 1 ? "" : "s", why);
}

}  // namespace

std::size_t lift_back_to_back_facets(Scene& scene) {
    assert(all_indices_in_range(scene));
    const std::vector<Index> asked = one_sided_instances(scene);
    if (asked.empty()) return 0;
    const LocalPositions local{scene};
    const std::vector<Placed> facets = suspects(local, asked);
    std::map<Index, std::pair<Index, std::set<Index>>> lifted;  // by mesh: an instance, facets
    for (std::size_t i = 1, first = 0; i < facets.size(); ++i) {
        if (facets[i].hash != facets[first].hash) first = i;
        if (first == i || turn_of(local, facets[i]) == turn_of(local, facets[first]) ||
            !same_corners(corners(local, facets[first]), corners(local, facets[i])))
            continue;
        for (const Placed& one : {facets[first], facets[i]}) {
            auto& [instance, of_mesh] = lifted[scene.instances[one.instance].mesh];
            instance = one.instance;
            of_mesh.insert(one.facet);
        }
    }
    if (lifted.empty()) return 0;
    // Twice that lies between both: more than POV-Ray's least distance, and far more than float32's
    // rounding.
    const double height = 4 * least_distance / normalising_factor(bounds(scene));
    std::size_t count = 0;
    for (const auto& [mesh, of_mesh] : lifted) {
        lift(scene.meshes[mesh], scene.instances[of_mesh.first].transform, of_mesh.second, height);
        count += of_mesh.second.size();
    }
    return count;
}

Losses shown_backs(const Scene& scene) {
    assert(all_indices_in_range(scene));
    std::map<Index, Backs> worst;  // by material
    const std::vector<Backs> all = backs(scene);
    std::map<Index, bool> bodies;  // by mesh
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].lean == 0) continue;
        const Index index = scene.instances[i].mesh;
        const Mesh& mesh = scene.meshes[index];
        const auto [body, unknown] = bodies.try_emplace(index, false);
        if (unknown) body->second = opaque(scene.materials[mesh.material]) && bounds_body(mesh);
        // The fronts of a body are to be seen as well.
        if (body->second && (!all[i].hidden || all[i].from > 0)) continue;
        const auto [entry, added] = worst.try_emplace(mesh.material, all[i]);
        if (added) continue;
        Backs& found = entry->second;
        found = {.hidden = found.hidden && all[i].hidden,
                 .from = std::max(found.from, all[i].from),
                 .lean = std::max(found.lean, all[i].lean)};
    }
    Losses losses;
    for (const auto& [material, found] : worst)
        losses.push_back({Loss::approximated, scene.materials[material].name, what_shows(found)});
    return losses;
}

}  // namespace penumbra
