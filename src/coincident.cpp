// Facets that lie exactly on one another: which of them a ray hits is a matter of rounding.
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

namespace penumbra {

namespace {

// A facet of an instance, by a hash of its corners in the world whatever their order.
struct Placed {
    std::uint64_t hash = 0;
    Index instance = 0, facet = 0;
};

std::uint64_t mixed(std::uint64_t x) {
    // SplitMix64's finaliser (Steele, Lea and Flood 2014).
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31U);
}

std::uint64_t hash_of(const Vec3f& p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis)
        hash = mixed(hash + 0x9E3779B97F4A7C15U + std::bit_cast<std::uint32_t>(p[axis] + 0.0F));
    return hash;
}

std::array<Vec3f, 3> corners(const Scene& scene, const Placed& placed) {
    const Instance& instance = scene.instances[placed.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::array<Vec3f, 3> points;
    for (std::size_t i = 0; i < 3; ++i)
        points[i] =
            Vec3f(Vec3(mesh.positions[mesh.triangles[placed.facet][i]]) * instance.transform);
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

std::vector<Placed> opaque_facets(const Scene& scene) {
    std::vector<Placed> facets;
    facets.reserve(facet_count(scene));
    std::vector<std::uint64_t> hashes;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[instance.mesh];
        if (!opaque(scene.materials[mesh.material])) continue;
        hashes.clear();
        for (const Vec3f& p : mesh.positions)
            hashes.push_back(hash_of(Vec3f(Vec3(p) * instance.transform)));
        for (Index k = 0; k < mesh.triangles.size(); ++k) {
            const auto& [a, b, c] = mesh.triangles[k];
            facets.push_back({mixed(hashes[a] + hashes[b] + hashes[c]), i, k});
        }
    }
    return facets;
}

}  // namespace

std::size_t drop_coincident_facets(Scene& scene) {
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    std::vector<Placed> facets = opaque_facets(scene);
    std::sort(facets.begin(), facets.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.hash, a.instance, a.facet) < std::tie(b.hash, b.instance, b.facet);
    });
    std::map<Index, std::vector<Index>> dropped;  // by mesh
    std::size_t count = 0;
    for (std::size_t i = 1, first = 0; i < facets.size(); ++i) {
        if (facets[i].hash != facets[first].hash) first = i;
        const Index mesh = scene.instances[facets[i].instance].mesh;
        // A shared mesh is wanted whole elsewhere.
        if (first == i || uses[mesh] != 1 ||
            !same_corners(corners(scene, facets[first]), corners(scene, facets[i])))
            continue;
        dropped[mesh].push_back(facets[i].facet);
        ++count;
    }
    for (auto& [index, list] : dropped) {
        std::sort(list.begin(), list.end());
        auto& triangles = scene.meshes[index].triangles;
        Index facet = 0;
        std::erase_if(triangles, [&](const auto&) {
            return std::binary_search(list.begin(), list.end(), facet++);
        });
    }
    return count;
}

}  // namespace penumbra
