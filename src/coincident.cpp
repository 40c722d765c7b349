// Facets that lie exactly on one another: which of them a ray hits is a matter of rounding.
#include "mixed.h"
#include "parallel.h"

#include "penumbra/scene.h"

#include <algorithm>
#include <bit>
#include <map>
#include <tuple>

namespace penumbra {

namespace {

// A facet of an instance, by a hash of its corners in the world whatever their order.
struct Placed {
    std::uint64_t hash = 0;
    Index instance = 0, facet = 0;
};

std::uint64_t hash_of(const Vec3f& p) {
    std::uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis)
        hash = mixed(hash + std::bit_cast<std::uint32_t>(p[axis] + 0.0F));
    return hash;
}

Vec3f placed_point(const Vec3f& p, const Instance& instance) {
    return Vec3f(Vec3(p) * instance.transform);
}

// Calls visit(Placed) for all opaque facets of the instances in the list.
template <class Visit>
void each_facet(const Scene& scene, const std::vector<Index>& instances, Visit visit) {
    std::vector<std::uint64_t> hashes;
    for (const Index i : instances) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        hashes.resize(mesh.positions.size());
        for_each_block(hashes.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k)
                hashes[k] = hash_of(placed_point(mesh.positions[k], scene.instances[i]));
        });
        for (Index k = 0; k < mesh.triangles.size(); ++k) {
            const auto& [a, b, c] = mesh.triangles[k];
            visit(Placed{mixed(hashes[a] + hashes[b] + hashes[c]), i, k});
        }
    }
}

// A set that may say yes to what it does not hold: one bit for a hash.
class Sieve {
  public:
    explicit Sieve(std::size_t count)
        : bits_(std::bit_ceil(std::max<std::size_t>(count, 64)) / 4), mask_(bits_.size() * 64 - 1) {
    }
    /// Whether something with this hash, or another that looks alike, was there already.
    bool insert(std::uint64_t hash) {
        const std::uint64_t at = hash & mask_, bit = std::uint64_t(1) << (at % 64);
        std::uint64_t& word = bits_[at / 64];
        const bool there = (word & bit) != 0;
        word |= bit;
        return there;
    }
    bool contains(std::uint64_t hash) const {
        const std::uint64_t at = hash & mask_;
        return (bits_[at / 64] >> (at % 64) & 1U) != 0;
    }

  private:
    std::vector<std::uint64_t> bits_;
    std::uint64_t mask_;
};

std::array<Vec3f, 3> corners(const Scene& scene, const Placed& placed) {
    const Instance& instance = scene.instances[placed.instance];
    const Mesh& mesh = scene.meshes[instance.mesh];
    std::array<Vec3f, 3> points;
    for (std::size_t i = 0; i < 3; ++i)
        points[i] = placed_point(mesh.positions[mesh.triangles[placed.facet][i]], instance);
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

// Opaque instances, if facets of any may be dropped: a mesh that several of them share is wanted
// whole elsewhere.
std::vector<Index> instances_to_ask(const Scene& scene, const std::vector<std::size_t>& uses) {
    std::vector<Index> asked;
    bool any = false;
    for (Index i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (!opaque(scene.materials[mesh.material])) continue;
        any = any || uses[scene.instances[i].mesh] == 1;
        asked.push_back(i);
    }
    if (!any) asked.clear();
    return asked;
}

// Facets of which there may be several, most likely all of them.
std::vector<Placed> suspects(const Scene& scene, const std::vector<Index>& instances) {
    std::size_t count = 0;
    for (const Index i : instances) count += scene.meshes[scene.instances[i].mesh].triangles.size();
    Sieve seen(count), twice(count / 16);
    bool any = false;
    each_facet(scene, instances, [&](const Placed& facet) {
        if (!seen.insert(facet.hash)) return;
        twice.insert(facet.hash);
        any = true;
    });
    std::vector<Placed> found;
    if (!any) return found;
    each_facet(scene, instances, [&](const Placed& facet) {
        if (twice.contains(facet.hash)) found.push_back(facet);
    });
    std::sort(found.begin(), found.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.hash, a.instance, a.facet) < std::tie(b.hash, b.instance, b.facet);
    });
    return found;
}

void drop(Mesh& mesh, std::vector<Index>& facets) {
    std::sort(facets.begin(), facets.end());
    Index facet = 0;
    std::erase_if(mesh.triangles, [&](const auto&) {
        return std::binary_search(facets.begin(), facets.end(), facet++);
    });
}

}  // namespace

std::size_t drop_coincident_facets(Scene& scene) {
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    const std::vector<Placed> facets = suspects(scene, instances_to_ask(scene, uses));
    std::map<Index, std::vector<Index>> dropped;  // by mesh
    std::size_t count = 0;
    for (std::size_t i = 1, first = 0; i < facets.size(); ++i) {
        if (facets[i].hash != facets[first].hash) first = i;
        const Index mesh = scene.instances[facets[i].instance].mesh;
        if (first == i || uses[mesh] != 1 ||
            !same_corners(corners(scene, facets[first]), corners(scene, facets[i])))
            continue;
        dropped[mesh].push_back(facets[i].facet);
        ++count;
    }
    for (auto& [mesh, list] : dropped) drop(scene.meshes[mesh], list);
    return count;
}

}  // namespace penumbra
