// What becomes of normal maps, as the user chose.
#include "prepare/body.h"
#include "scene/defects.h"
#include "scene/normal_map.h"

#include "penumbra/prepare.h"

#include <cassert>

namespace penumbra {

namespace {

// Of all meshes with normal maps together: POV-Ray reads about 100,000 facets a second.
constexpr std::size_t most_baked_facets = 100'000;

}  // namespace

Losses settle_normal_maps(Scene& scene, NormalMaps choice) {
    assert(surface_defects(scene).empty());
    if (choice == NormalMaps::pixel) {
        complete_tangents(scene);
        return {};
    }
    Losses losses = choice == NormalMaps::bake
                        ? bake_normal_maps(scene, {.facets = most_baked_facets})
                        : drop_normal_maps(scene);
    show_whole_bodies(scene);  // by the normals that stay
    return losses;
}

}  // namespace penumbra
