// Facets that lie exactly on one another: which of them a ray hits is a matter of rounding.
#include "prepare/same_corners.h"
#include "prepare/scale.h"
#include "scene/defects.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

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

// Not where the other one shows two sides and the kept one does not.
bool shows_all_of(const Scene& scene, const Placed& kept, const Placed& other) {
    const auto sides = [&](const Placed& p) {
        return scene.materials[scene.meshes[scene.instances[p.instance].mesh].material].sides;
    };
    return sides(kept) == Sides::both || sides(other) == Sides::front;
}

}  // namespace

std::size_t drop_coincident_facets(Scene& scene) {
    assert(all_indices_in_range(scene));
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    const std::vector<Index> asked = instances_to_ask(scene, uses);
    if (asked.empty()) return 0;
    const LocalPositions local{scene};
    const std::vector<Placed> facets = suspects(local, asked);
    std::map<Index, std::vector<Index>> dropped;  // by instance
    std::size_t count = 0;
    // The last one stays, as viewers draw it over the others.
    for (std::size_t i = facets.size(), last = i; i-- > 0;) {
        if (last == facets.size() || facets[i].hash != facets[last].hash) last = i;
        if (last == i || !shows_all_of(scene, facets[last], facets[i]) ||
            !same_corners(corners(local, facets[last]), corners(local, facets[i])))
            continue;
        dropped[facets[i].instance].push_back(facets[i].facet);
        ++count;
    }
    for (auto& [instance, list] : dropped) std::ranges::sort(list);
    drop(scene, dropped, uses);
    return count;
}

}  // namespace penumbra
