#include "prepare/same_corners.h"

#include "base/hash.h"
#include "base/parallel.h"
#include "prepare/scale.h"
#include "prepare/sieve.h"
#include "prepare/weld.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace penumbra {

namespace {

// Calls visit(Placed) for all facets of the instances in the list.
template <class Visit>
void each_facet(const LocalPositions& local, const std::vector<Index>& instances, Visit visit) {
    const Scene& scene = local.scene;
    std::vector<std::uint64_t> hashes;
    for (const Index i : instances) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        hashes.resize(mesh.positions.size());
        for_each_block(hashes.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k)
                hashes[k] = hash_of_point(local.place(mesh.positions[k], scene.instances[i]));
        });
        for (Index k = 0; k < mesh.triangles.size(); ++k) {
            const auto& [a, b, c] = mesh.triangles[k];
            const std::array sum = {hashes[a] + hashes[b] + hashes[c]};
            visit(Placed{hash_of(std::as_bytes(std::span(sum))), i, k});
        }
    }
}

}  // namespace

std::array<Vec3f, 3> corners(const LocalPositions& local, const Placed& placed) {
    const Instance& instance = local.scene.instances[placed.instance];
    const Mesh& mesh = local.scene.meshes[instance.mesh];
    std::array<Vec3f, 3> points;
    for (std::size_t i = 0; i < 3; ++i)
        points[i] = local.place(mesh.positions[mesh.triangles[placed.facet][i]], instance);
    return points;
}

bool same_corners(std::array<Vec3f, 3> a, std::array<Vec3f, 3> b) {
    const auto before = [](const Vec3f& p, const Vec3f& q) {
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    std::sort(a.begin(), a.end(), before);
    std::sort(b.begin(), b.end(), before);
    return a == b;
}

std::vector<Placed> suspects(const LocalPositions& local, const std::vector<Index>& instances) {
    const Scene& scene = local.scene;
    std::size_t count = 0;
    for (const Index i : instances) count += scene.meshes[scene.instances[i].mesh].triangles.size();
    Sieve seen(count), twice(count / 16);
    bool any = false;
    each_facet(local, instances, [&](const Placed& facet) {
        if (!seen.insert(facet.hash)) return;
        twice.insert(facet.hash);
        any = true;
    });
    std::vector<Placed> found;
    if (!any) return found;
    each_facet(local, instances, [&](const Placed& facet) {
        if (twice.contains(facet.hash)) found.push_back(facet);
    });
    std::sort(found.begin(), found.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.hash, a.instance, a.facet) < std::tie(b.hash, b.instance, b.facet);
    });
    return found;
}

bool may_coincide(const Scene& scene) {
    if (facet_count(scene) > most_facets) return true;
    std::vector<Index> asked;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Material& m = scene.materials[scene.meshes[scene.instances[i].mesh].material];
        if (opaque(m) || m.sides == Sides::front) asked.push_back(i);
    }
    const std::vector<Placed> found = suspects(LocalPositions{scene}, asked);
    return std::ranges::adjacent_find(found, {}, &Placed::hash) != found.end();
}

}  // namespace penumbra
