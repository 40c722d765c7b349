#include "tracer/accel/embree.h"
#include "tracer/accel/facets.h"

#include <algorithm>
#include <tuple>

namespace penumbra {

void FacetAccel::translucent(const Vec3& origin, const Vec3& direction, double farthest,
                             std::vector<Hit>& hits) const {
    hits.clear();
    if (!translucent_ || !embree::takes(direction)) return;
    // A little farther, as float32 rounds distances.
    const double far = farthest + 100 * coordinate_rounding;
    embree::find_crossings(trees_.over(translucent_mask),
                           embree::single_ray(origin, direction, 0, far, translucent_mask).ray,
                           hits);
    for (Hit& hit : hits) hit.t = distance_to(hit.object, hit.facet, origin, direction);
    std::erase_if(hits, [&](const Hit& hit) { return !(hit.t < farthest); });
    std::ranges::sort(hits, {},
                      [](const Hit& hit) { return std::tuple(hit.t, hit.object, hit.facet); });
}

bool TranslucentFacets::next(double nearest, Hit& hit) {
    if (known_ == Known::none) {
        known_ = Known::first;
        return facets_.translucent(origin_, direction_, nearest, hit.t, hit);
    }
    if (known_ == Known::first) {
        facets_.translucent(origin_, direction_, farthest_, all_);
        known_ = Known::all;
    }
    while (at_ < all_.size() && !(all_[at_].t > nearest)) ++at_;
    if (at_ == all_.size() || !(all_[at_].t < hit.t)) return false;
    hit = all_[at_];
    return true;
}

}  // namespace penumbra
