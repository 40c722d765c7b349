// Facets that lie exactly on one another: which of them a ray hits is a matter of rounding.
#include "base/hash.h"
#include "base/parallel.h"
#include "prepare/scale.h"
#include "scene/transforms.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>
#include <tuple>

namespace penumbra {

namespace {

// A facet of an instance, by a hash of its corners in the world whatever their order.
struct Placed {
    std::uint64_t hash = 0;
    Index instance = 0, facet = 0;
};

// Equal numbers have equal bits, 0 and -0 too.
std::uint64_t hash_of_point(const Vec3f& p) {
    const std::array<float, 3> numbers = {p.x + 0.0F, p.y + 0.0F, p.z + 0.0F};
    return hash_of(std::as_bytes(std::span(numbers)));
}

// What is asked of a scene, and where its positions are counted from: in float32, in which
// neighbours are the same place, they must not be far away.
struct World {
    const Scene& scene;
    Vec3 origin = local_origin(bounds(scene));

    Vec3f place(const Vec3f& p, const Instance& instance) const {
        return Vec3f(Vec3(p) * instance.transform - origin);
    }
};

// Calls visit(Placed) for all opaque facets of the instances in the list.
template <class Visit>
void each_facet(const World& world, const std::vector<Index>& instances, Visit visit) {
    const Scene& scene = world.scene;
    std::vector<std::uint64_t> hashes;
    for (const Index i : instances) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        hashes.resize(mesh.positions.size());
        for_each_block(hashes.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k)
                hashes[k] = hash_of_point(world.place(mesh.positions[k], scene.instances[i]));
        });
        for (Index k = 0; k < mesh.triangles.size(); ++k) {
            const auto& [a, b, c] = mesh.triangles[k];
            const std::array sum = {hashes[a] + hashes[b] + hashes[c]};
            visit(Placed{hash_of(std::as_bytes(std::span(sum))), i, k});
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

std::array<Vec3f, 3> corners(const World& world, const Placed& placed) {
    const Instance& instance = world.scene.instances[placed.instance];
    const Mesh& mesh = world.scene.meshes[instance.mesh];
    std::array<Vec3f, 3> points;
    for (std::size_t i = 0; i < 3; ++i)
        points[i] = world.place(mesh.positions[mesh.triangles[placed.facet][i]], instance);
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

// Opaque instances, if there is anything to ask: of scenes with more than most_facets, only where
// some can be dropped without a copy.
std::vector<Index> instances_to_ask(const Scene& scene, const std::vector<std::size_t>& uses) {
    std::vector<Index> asked;
    bool any = facet_count(scene) <= most_facets;
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
std::vector<Placed> suspects(const World& world, const std::vector<Index>& instances) {
    const Scene& scene = world.scene;
    std::size_t count = 0;
    for (const Index i : instances) count += scene.meshes[scene.instances[i].mesh].triangles.size();
    Sieve seen(count), twice(count / 16);
    bool any = false;
    each_facet(world, instances, [&](const Placed& facet) {
        if (!seen.insert(facet.hash)) return;
        twice.insert(facet.hash);
        any = true;
    });
    std::vector<Placed> found;
    if (!any) return found;
    each_facet(world, instances, [&](const Placed& facet) {
        if (twice.contains(facet.hash)) found.push_back(facet);
    });
    std::sort(found.begin(), found.end(), [](const Placed& a, const Placed& b) {
        return std::tie(a.hash, a.instance, a.facet) < std::tie(b.hash, b.instance, b.facet);
    });
    return found;
}

// Without `facets`, which are sorted.
void drop(Mesh& mesh, const std::vector<Index>& facets) {
    Index facet = 0;
    std::erase_if(mesh.triangles, [&](const auto&) {
        return std::binary_search(facets.begin(), facets.end(), facet++);
    });
}

Mesh without(const Mesh& mesh, const std::vector<Index>& facets) {
    if (facets.size() == mesh.triangles.size())
        return {.name = mesh.name, .material = mesh.material};
    Mesh copy = mesh;
    drop(copy, facets);
    return copy;
}

// Drops facets of the instances' meshes, or of copies where other instances want them.
void drop(Scene& scene, const std::map<Index, std::vector<Index>>& by_instance,
          std::vector<std::size_t>& uses) {
    std::map<std::pair<Index, std::vector<Index>>, std::vector<Index>> alike;
    for (const auto& [instance, facets] : by_instance)
        alike[{scene.instances[instance].mesh, facets}].push_back(instance);
    for (const auto& [what, instances] : alike) {
        const auto& [mesh, facets] = what;
        if (uses[mesh] == instances.size()) {
            drop(scene.meshes[mesh], facets);
            continue;
        }
        uses[mesh] -= instances.size();
        for (const Index i : instances) scene.instances[i].mesh = Index(scene.meshes.size());
        scene.meshes.push_back(without(scene.meshes[mesh], facets));
    }
}

}  // namespace

std::size_t drop_coincident_facets(Scene& scene) {
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    const World world{scene};
    const std::vector<Placed> facets = suspects(world, instances_to_ask(scene, uses));
    std::map<Index, std::vector<Index>> dropped;  // by instance
    std::size_t count = 0;
    for (std::size_t i = 1, first = 0; i < facets.size(); ++i) {
        if (facets[i].hash != facets[first].hash) first = i;
        if (first == i || !same_corners(corners(world, facets[first]), corners(world, facets[i])))
            continue;
        dropped[facets[i].instance].push_back(facets[i].facet);
        ++count;
    }
    for (auto& [instance, list] : dropped) std::ranges::sort(list);
    drop(scene, dropped, uses);
    return count;
}

}  // namespace penumbra
