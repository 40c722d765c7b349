#include "prepare/surfaces/near_surfaces.h"

#include "base/memory.h"
#include "prepare/surfaces/facet_overlaps.h"
#include "prepare/surfaces/seen.h"
#include "prepare/surfaces/world_facets.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

namespace penumbra {

namespace {

// Such scenes are left alone: it would take seconds to tell.
constexpr std::size_t most_pairs = std::size_t(1) << 22;

// Light goes on behind it, weaker. What a mask leaves of a surface hides its own shadow so near by.
bool see_through(const Material& m) { return !opaque(m) && !(m.alpha_map && m.alpha_map->cutoff); }

Bounds grown(Bounds box, double by) {
    box.min -= Vec3(by);
    box.max += Vec3(by);
    return box;
}

bool touch(const Bounds& a, const Bounds& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
    return true;
}

Bounds box_of(const WorldFacet& facet) {
    Bounds box;
    for (const Vec3& corner : facet.corners) box.extend(corner);
    return box;
}

// Of which instance one is, of which the other, how far they are apart in the units of WorldFacets.
struct Near {
    Index caster = no_index, other = no_index;
    double gap = std::numeric_limits<double>::infinity();
    std::size_t count = 0;
};

class NearSurfaces {
  public:
    NearSurfaces(const Scene& scene, const Bounds& box, const View& view, int height)
        : facets_(scene, box), eye_(facets_.place(view.location)) {
        // A pixel's width is this, times the distance from the eye in perspective.
        pixel_ = view.up.length() / height * (view.orthographic ? facets_.factor() : 1);
        orthographic_ = view.orthographic;
        // Where a gap of that margin is a pixel wide at least.
        reach_ = !orthographic_            ? shadow_margin / pixel_
                 : pixel_ <= shadow_margin ? std::numeric_limits<double>::infinity()
                                           : 0;
    }

    Near find() {
        collect();
        const MemoryClaim claim(times(boxes_.size(), 2 * sizeof(GroupedBox)), "near facets");
        each_touching_pair(boxes_, [&](Index a, Index b) {
            if (++pairs_ > most_pairs) return;
            if (!offer(a, b)) offer(b, a);
        });
        near_.count = casters_.size();
        return near_;
    }

    double factor() const { return facets_.factor(); }

  private:
    bool casts(Index instance) const { return see_through(facets_.material_of(instance)); }

    // Of each instance the part where what light passes touches it, or it touches others as such.
    std::vector<Bounds> parts_to_ask() {
        std::vector<Bounds> parts(facets_.scene().instances.size());
        if (std::ranges::none_of(facets_.scene().materials, see_through)) return parts;
        std::vector<GroupedBox> boxes;
        for (Index i = 0; i < parts.size(); ++i)
            boxes.push_back({grown(facets_.box_of(i), shadow_margin), i, i});
        each_touching_pair(boxes, [&](Index a, Index b) {
            if (++pairs_ > most_pairs || !(casts(a) || casts(b))) return;
            for (const auto& [one, other] : {std::pair(a, b), std::pair(b, a)}) {
                const Bounds box = grown(facets_.box_of(other), shadow_margin);
                parts[one].extend(box.min);
                parts[one].extend(box.max);
            }
        });
        return parts;
    }

    // Facets of those parts, and what is near the eye.
    void collect() {
        const std::vector<Bounds> parts = parts_to_ask();
        for (Index i = 0; i < parts.size(); ++i) {
            const bool near = distance(eye_, facets_.box_of(i)) <= reach_;
            if (parts[i].empty() && !near) continue;
            const Index first = facets_.first_of(i);
            for (Index number = first; number < facets_.first_of(i + 1); ++number) {
                const auto facet = facets_.at(i, number - first);
                if (!facet) continue;
                const Bounds box = grown(box_of(*facet), shadow_margin / 2);
                if (touch(parts[i], box) || (near && distance(eye_, box) <= reach_))
                    boxes_.push_back({box, number, i});
            }
        }
    }

    // Does facet a cast a shadow on b that is lost?
    bool offer(Index a, Index b) {
        const Index caster = facets_.instance_of(a), other = facets_.instance_of(b);
        const WorldFacet at_a = *facets_.at(caster, a - facets_.first_of(caster));
        const WorldFacet at_b = *facets_.at(other, b - facets_.first_of(other));
        if (!overlap(at_a, at_b, shadow_margin) || overlap(at_a, at_b)) return false;
        const double gap = std::min(height(at_a, at_b), height(at_b, at_a));
        if (!casts(caster) && (gap < pixel_at(at_a) || size(caster) > size(other))) return false;
        casters_.insert(a);
        if (gap < near_.gap) near_ = {.caster = caster, .other = other, .gap = gap};
        return true;
    }

    double pixel_at(const WorldFacet& facet) const {
        return orthographic_ ? pixel_ : pixel_ * distance(eye_, box_of(facet));
    }

    double size(Index instance) const { return facets_.box_of(instance).radius(); }

    // Of the corner that is farthest from the plane of the other one.
    static double height(const WorldFacet& facet, const WorldFacet& plane) {
        double most = 0;
        for (const Vec3& corner : facet.corners)
            most = std::max(most, std::abs(plane.height(corner)));
        return most;
    }

    WorldFacets facets_;
    Vec3 eye_;
    double pixel_ = 0, reach_ = 0;
    bool orthographic_ = false;
    std::vector<GroupedBox> boxes_;
    std::size_t pairs_ = 0;
    std::unordered_set<Index> casters_;
    Near near_;
};

}  // namespace

Losses losses_by_nearness(const Scene& scene, const Bounds& box, int width, int height) {
    const View view = view_of(scene.cameras[scene.camera], width, height);
    NearSurfaces surfaces(scene, box, view, height);
    const Near near = surfaces.find();
    if (near.count == 0) return {};
    return {{Loss::approximated, "tolerances",
             fmt::format("{} facets lie nearer to others than {:.2g}, below which POV-Ray's "
                         "tolerance leaves out shadows in a scene that measures {:.3g} across; the "
                         "nearest is of {}, {:.2g} from {}",
                         near.count, shadow_margin / surfaces.factor(), 2 * box.radius(),
                         described(scene, near.caster), near.gap / surfaces.factor(),
                         described(scene, near.other)),
             near.count}};
}

}  // namespace penumbra
