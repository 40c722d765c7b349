#include "prepare/surfaces/facet_sides.h"

namespace penumbra {

bool must_be_parted(const Side& a, const Side& b, bool facing) {
    // A ray that passes a back which is not shown misses a front that lies no farther.
    const bool holes = !facing && (a.one_sided || b.one_sided);
    if (a.material == b.material && a.plain && b.plain && !holes) return false;
    // Where two bodies touch nobody looks, and the two sides of a sheet may be two facets.
    const bool bodies = a.opaque && b.opaque && a.solid && b.solid;
    const bool sheet = a.instance == b.instance && a.material == b.material && !holes;
    return facing || !(bodies || sheet);
}

Side side_of(const WorldFacets& facets, Index number) {
    const Index instance = facets.instance_of(number);
    const Index facet = number - facets.first_of(instance);
    return {.instance = instance,
            .material = facets.mesh_of(instance).material,
            .plain = facets.plain(instance, facet),
            .opaque = opaque(facets.material_of(instance)),
            .solid = facets.solid(instance, facet),
            .one_sided = facets.material_of(instance).sides == Sides::front};
}

}  // namespace penumbra
