#include "prepare/surfaces/patch_places.h"

#include "prepare/surfaces/facet_sides.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace penumbra {

namespace {

// What a body stands on and the side that it stands with are not seen at once, so that little is
// enough to part them: more than rounding and POV-Ray's least distance. Through a sheet that
// light passes POV-Ray has to see the side, and its shadow.
constexpr double beneath_a_body = 0.06, beneath_a_body_seen = 0.5;

// By so much larger than others is what is not to move. The step is some 1/50,000 of the largest.
constexpr double by_far = 16;

// In the order of the file, each upon those before.
PatchPlaces in_order_of_file(const WorldFacets& facets,
                             const std::vector<OverlappingPatches>& overlaps) {
    PatchPlaces places;
    for (const OverlappingPatches& o : overlaps) {
        if (o.lower != no_index) places[o.lower];
        places[o.upper].turned |= o.turned;
    }
    std::vector<OverlappingPatches> in_order = overlaps;
    std::ranges::stable_sort(in_order, [&](const auto& a, const auto& b) {
        const Index i = facets.instance_of(a.upper), j = facets.instance_of(b.upper);
        return i == j ? a.upper < b.upper : lies_on(facets, j, i);
    });
    for (const OverlappingPatches& o : in_order) {
        PatchPlace& upper = places[o.upper];
        const PatchPlace lower = o.lower == no_index ? PatchPlace{} : places[o.lower];
        const bool one_way = o.facing != (upper.turned != lower.turned);
        upper.level = std::max(upper.level, (one_way ? lower.level : -lower.level) + 1);
    }
    return places;
}

// Patches of one plane that lie on one another, directly or by others.
struct Stack {
    std::vector<Index> patches = {};
    bool fixed = false;  // on a plane of the scene
};

std::vector<Stack> stacks_of(const std::vector<OverlappingPatches>& overlaps) {
    std::map<Index, Index> parent;
    const auto root = [&](Index i) {
        parent.try_emplace(i, i);
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const OverlappingPatches& o : overlaps) {
        const Index a = root(o.upper), b = root(o.lower == no_index ? o.upper : o.lower);
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::map<Index, Stack> stacks;
    for (const auto& [patch, above] : parent) stacks[root(patch)].patches.push_back(patch);
    for (const OverlappingPatches& o : overlaps)
        if (o.lower == no_index) stacks[root(o.upper)].fixed = true;
    std::vector<Stack> result;
    for (auto& [name, stack] : stacks) result.push_back(std::move(stack));
    return result;
}

WorldFacet facet_of(const WorldFacets& facets, Index number) {
    const Index instance = facets.instance_of(number);
    return facets.at(instance, number - facets.first_of(instance)).value_or(WorldFacet{});
}

using Sizes = std::unordered_map<Index, double>;  // lengths of patches

Sizes sizes_of(const WorldFacets& facets, const std::vector<Index>& patch,
               const PatchPlaces& places) {
    std::unordered_map<Index, Bounds> boxes;
    for (Index i = 0; i < facets.scene().instances.size(); ++i)
        for (Index number = facets.first_of(i); number < facets.first_of(i + 1); ++number) {
            if (!places.contains(patch[number])) continue;
            if (const auto facet = facets.at(i, number - facets.first_of(i)))
                for (const Vec3& corner : facet->corners) boxes[patch[number]].extend(corner);
        }
    Sizes sizes;
    for (const auto& [name, box] : boxes) sizes[name] = 2 * box.radius();
    return sizes;
}

// Moves a stack so that its largest patch stays where that is far larger than those that would.
// Returns whether it did.
bool settle(const WorldFacets& facets, const Stack& stack, const Sizes& sizes,
            PatchPlaces& places) {
    const auto size = [&](Index patch) { return sizes.at(patch); };
    const Index largest = *std::ranges::max_element(stack.patches, {}, size);
    const double level = places[largest].level;
    if (stack.fixed || level == 0) return false;
    for (const Index patch : stack.patches)
        if (places[patch].level == 0 && size(patch) * by_far > size(largest)) return false;
    const Vec3 up = facet_of(facets, largest).normal * (places[largest].turned ? -1 : 1);
    for (const Index patch : stack.patches) {
        PatchPlace& place = places[patch];
        const bool along = (facet_of(facets, patch).normal.dot(up) > 0) != place.turned;
        place.level -= along ? level : -level;
    }
    return true;
}

double outwards(const PatchPlace& place) { return place.turned ? -place.level : place.level; }

using Shares = std::map<Index, double>;  // of their levels, by patch

// Patches that are sides of bodies and stand on sheets. `moved` are those of stacks that were
// settled; others stay in their bodies.
Shares standing(const WorldFacets& facets, const std::vector<OverlappingPatches>& overlaps,
                const std::set<Index>& moved, const PatchPlaces& places) {
    Shares shares;
    for (const OverlappingPatches& o : overlaps) {
        if (o.facing || o.lower == no_index) continue;
        const Side upper = side_of(facets, o.upper), lower = side_of(facets, o.lower);
        const bool both_opaque = upper.opaque && lower.opaque;
        const double share = both_opaque ? beneath_a_body : beneath_a_body_seen;
        for (const auto& [patch, side] : {std::pair(o.upper, upper), std::pair(o.lower, lower)}) {
            const double way = outwards(places.at(patch));
            if (side.solid && (way < 0 ? moved.contains(patch) : way > 0 && both_opaque))
                shares[patch] = std::max(shares[patch], share);
        }
    }
    return shares;
}

// Leaves what lies on others that do not come as near.
void keep_order(std::vector<OverlappingPatches> overlaps, const PatchPlaces& places,
                Shares& shares) {
    const auto level = [&](Index patch) { return patch == no_index ? 0 : places.at(patch).level; };
    std::ranges::stable_sort(overlaps, {}, [&](const auto& o) { return level(o.upper); });
    for (const OverlappingPatches& o : overlaps)
        if (o.facing && level(o.lower) > 0 && !shares.contains(o.lower)) shares.erase(o.upper);
}

// Tears sides of bodies from the rest where they stand on sheets, so that the body keeps its height
// and no gap opens.
void tear_off(const WorldFacets& facets, const std::vector<OverlappingPatches>& overlaps,
              const std::set<Index>& moved, PatchPlaces& places) {
    Shares shares = standing(facets, overlaps, moved, places);
    keep_order(overlaps, places, shares);
    for (const auto& [patch, share] : shares) {
        PatchPlace& place = places[patch];
        // Within bodies nobody sees which of several is the highest.
        if (outwards(place) < 0) place.level = std::copysign(1, place.level);
        place.level *= share;
        place.torn = true;
    }
}

}  // namespace

PatchPlaces places_of(const WorldFacets& facets, const CoplanarPatches& found) {
    PatchPlaces places = in_order_of_file(facets, found.overlaps);
    const Sizes sizes = sizes_of(facets, found.patch, places);
    std::set<Index> moved;
    for (const Stack& stack : stacks_of(found.overlaps))
        if (settle(facets, stack, sizes, places))
            moved.insert(stack.patches.begin(), stack.patches.end());
    tear_off(facets, found.overlaps, moved, places);
    return places;
}

}  // namespace penumbra
