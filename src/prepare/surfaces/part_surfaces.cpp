// Surfaces that lie in one plane: which of them a ray meets first is a matter of rounding, and what
// lies nearer than POV-Ray's tolerances behind a surface that light passes through is not met at
// all.
#include "prepare/scale.h"
#include "prepare/surfaces/coincident_shapes.h"
#include "prepare/surfaces/coplanar_patches.h"
#include "prepare/surfaces/facet_lifter.h"
#include "prepare/surfaces/patch_places.h"
#include "prepare/surfaces/world_facets.h"
#include "scene/defects.h"

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

namespace penumbra {

namespace {

// Between layers, in the units of a normalised scene. More than both tolerances, 1e-4 of rays and
// 1e-3 of shadow rays, even where the lifted facets make the scene so much larger that it gets half
// the scale; a pixel is some ten times wider.
constexpr double layer = 2.5e-3;

// Facets of copies that are made for instances.
constexpr std::size_t most_copied = most_facets;

using ByInstance = std::map<Index, std::vector<LevelledFacet>>;

// Facets of patches that lie on others or beneath them, for instances of which some are lifted.
ByInstance levelled(const WorldFacets& facets, const CoplanarPatches& found,
                    const PatchPlaces& places) {
    ByInstance result;
    for (Index i = 0; i < facets.scene().instances.size(); ++i) {
        std::vector<LevelledFacet> list;
        bool any = false;
        const Index first = facets.first_of(i);
        for (Index number = first; number < facets.first_of(i + 1); ++number) {
            const auto place = places.find(found.patch[number]);
            if (place == places.end()) continue;
            const auto facet = facets.at(i, number - first);
            const auto named_by = facets.at(i, place->first - first);
            if (!facet || !named_by) continue;
            // A patch has one side, whatever the winding of its facets.
            const bool other = facet->normal.dot(named_by->normal) < 0;
            const auto& [level, turned, torn] = place->second;
            list.push_back({number - first, level, turned != other, torn});
            any |= level != 0;
        }
        if (any) result.emplace(i, std::move(list));
    }
    return result;
}

// What instances of a mesh have in common that can share the lifted copy of it: the facets, and the
// scales along the mesh's axes, to about one part in a hundred.
struct Kind {
    Index mesh = 0;
    std::array<long, 3> scales = {};
    std::vector<LevelledFacet> facets = {};
    auto operator<=>(const Kind&) const = default;
};

Kind kind_of(const Scene& scene, Index instance, const std::vector<LevelledFacet>& facets) {
    const Matrix& m = scene.instances[instance].transform;
    Kind kind = {.mesh = scene.instances[instance].mesh, .facets = facets};
    for (int row = 0; row < 3; ++row)
        kind.scales[std::size_t(row)] =
            std::lround(64 * std::log2(Vec3(m[row][0], m[row][1], m[row][2]).length()));
    return kind;
}

struct Count {
    std::size_t lifted = 0, left = 0;
    double step = 0;  // the longest one, in layers
};

// Those of `found`, and those that leave their bodies.
std::vector<TornFacet> all_torn(const WorldFacets& facets, const CoplanarPatches& found,
                                const ByInstance& levelled) {
    std::vector<TornFacet> torn = found.torn;
    for (const auto& [instance, list] : levelled)
        for (const LevelledFacet& f : list) {
            const Index first = facets.first_of(instance);
            if (f.torn)
                torn.push_back({facets.scene().instances[instance].mesh, f.facet,
                                found.patch[first + f.facet] - first});
        }
    return torn;
}

// Lifts facets of meshes, of copies where other instances want them as they are.
Count lift_all(Scene& scene, const ByInstance& levelled, double step) {
    std::map<Kind, std::vector<Index>> kinds;
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const Instance& i : scene.instances) ++uses[i.mesh];
    for (const auto& [instance, facets] : levelled)
        kinds[kind_of(scene, instance, facets)].push_back(instance);
    Count count;
    std::size_t copied = 0;
    for (const auto& [kind, instances] : kinds) {
        const auto lifted = std::size_t(std::ranges::count_if(
            kind.facets, [](const LevelledFacet& f) { return f.level != 0; }));
        Index mesh = kind.mesh;
        if (uses[mesh] != instances.size()) {
            const std::size_t facets = scene.meshes[mesh].triangles.size();
            if (copied + facets > most_copied) {
                count.left += lifted * instances.size();
                continue;
            }
            copied += facets;
            uses[mesh] -= instances.size();
            mesh = Index(scene.meshes.size());
            Mesh copy = scene.meshes[kind.mesh];
            scene.meshes.push_back(std::move(copy));
            for (const Index i : instances) scene.instances[i].mesh = mesh;
        }
        lift(scene.meshes[mesh], scene.instances[instances[0]].transform, kind.facets, step);
        count.lifted += lifted * instances.size();
        for (const LevelledFacet& f : kind.facets)
            count.step = std::max(count.step, std::min(1.0, std::abs(f.level)));
    }
    return count;
}

void say(Losses& losses, const char* place, std::size_t count, const std::string& what) {
    if (count > 0)
        losses.push_back({Loss::approximated, place, fmt::format("{} {}", count, what), count});
}

void part_facets(Scene& scene, const Bounds& box, Losses& losses) {
    const WorldFacets facets(scene, box);
    const CoplanarPatches found = coplanar_patches(facets);
    if (found.left)
        losses.push_back({Loss::approximated, "facets",
                          "many lie in one plane with others that they hang together with: which "
                          "of them shows is a matter of rounding"});
    if (found.overlaps.empty()) return;
    const ByInstance places = levelled(facets, found, places_of(facets, found));
    const double step = layer / facets.factor();
    center_meshes(scene, box.radius());
    tear(scene, all_torn(facets, found, places));
    const Count count = lift_all(scene, places, step);
    say(losses, "facets", count.lifted,
        fmt::format("that lie in one plane with others are lifted off it by {:.2g}: which of them "
                    "shows would be a matter of rounding",
                    step * count.step));
    say(losses, "facets", count.left,
        "that lie in one plane with others stay there: their instances are too many for a mesh "
        "each");
}

}  // namespace

Losses part_surfaces(Scene& scene) {
    assert(all_indices_in_range(scene));
    Losses losses;
    const Bounds box = bounds(scene);
    const double factor = normalising_factor(box);
    const PartedShapes shapes = part_coincident_shapes(scene, layer / factor, factor);
    say(losses, "spheres and planes", shapes.dropped,
        "that lie exactly on others are left out: which of them shows would be a matter of "
        "rounding");
    say(losses, "spheres and planes", shapes.moved,
        fmt::format("that lie exactly on others are lifted off them by {:.2g}: which of them shows "
                    "would be a matter of rounding",
                    layer / factor));
    part_facets(scene, box, losses);
    return losses;
}

}  // namespace penumbra
