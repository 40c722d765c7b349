#include "prepare/surfaces/coplanar_patches.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "prepare/sieve.h"
#include "prepare/surfaces/facet_overlaps.h"
#include "prepare/surfaces/facet_sides.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <unordered_set>

namespace penumbra {

namespace {

// ---- planes -------------------------------------------------------------------------------------

// Planes are sorted into cells of the space of their normals and distances. What may lie in one
// plane with something beyond the border of its cell belongs to both cells. A scene reaches up to
// 2 least_radius from its middle; normals of facets that are much larger than in_one_plane are as
// exact.
constexpr double normal_cell = 2e-3, normal_margin = 2e-5;
constexpr double distance_cell = least_radius / 400,
                 distance_margin = in_one_plane + 2 * least_radius * normal_margin;

// A border through 0 would cut the planes that are most frequent.
constexpr double border = 0.37;

// std::floor() without a call.
std::int64_t floored(double value) {
    const auto whole = std::int64_t(value);
    return whole - (double(whole) > value ? 1 : 0);
}

// Calls visit(hash) for the cells of a plane. A normal and its opposite are the same.
template <class Visit>
void each_cell(Vec3 normal, double distance, Visit visit) {
    const Vec3 nearly_never_perpendicular(0.8273, 0.4719, 0.3047);
    if (normal.dot(nearly_never_perpendicular) < 0) {
        normal = -normal;
        distance = -distance;
    }
    std::array<std::int64_t, 4> first{}, last{};
    unsigned twice = 0;  // bits: along which axes there are two cells
    for (unsigned i = 0; i < 4; ++i) {
        const bool is_distance = i == 3;
        // What a hostile scene has is not near to anything.
        const double at = is_distance ? std::clamp(distance, -1e6, 1e6) : normal[int(i)];
        constexpr double normals = 1 / normal_cell, distances = 1 / distance_cell;
        const double place = at * (is_distance ? distances : normals) + border;
        const double margin =
            is_distance ? distance_margin / distance_cell : normal_margin / normal_cell;
        const std::int64_t cell = floored(place);
        const double within = place - double(cell);
        first[i] = cell - (within < margin ? 1 : 0);
        last[i] = cell + (within >= 1 - margin ? 1 : 0);
        if (first[i] != last[i]) twice |= 1U << i;
    }
    for (unsigned some = twice;; some = (some - 1) & twice) {
        std::array<std::int64_t, 4> cell = first;
        for (unsigned i = 0; i < 4; ++i)
            if ((some >> i & 1U) != 0) cell[i] = last[i];
        visit(hash_of(std::as_bytes(std::span(cell))));
        if (some == 0) return;
    }
}

// What belongs to a plane of the scene as it does to a facet.
WorldFacet facet_in(const Plane& plane, const WorldFacets& facets) {
    return {.corners = {facets.place(plane.point)}, .normal = plane.normal.normalized()};
}

// Calls visit(hash) for the cells of a plane of the scene.
template <class Visit>
void each_cell(const Plane& plane, const WorldFacets& facets, Visit visit) {
    const WorldFacet in_it = facet_in(plane, facets);
    each_cell(in_it.normal, in_it.normal.dot(in_it.corners[0]), visit);
}

struct InCell {
    std::uint64_t cell = 0;
    Index facet = 0;
    auto operator<=>(const InCell&) const = default;
};

using Run = std::span<const InCell>;  // of one cell

bool share_corner(const WorldFacets& facets, Index instance, Index a, Index b) {
    const auto& triangles = facets.mesh_of(instance).triangles;
    const Index first = facets.first_of(instance);
    for (const Index corner : triangles[a - first])
        for (const Index other : triangles[b - first])
            if (corner == other) return true;
    return false;
}

// Cells in which a facet lies on one that stands just before it in its mesh.
using FoldedCells = std::vector<std::uint64_t>;

// Takes out what is alone in its cell, but for what follows it in the mesh and hangs together with
// it without a fold: most of a curved mesh. What may lie in a plane of the scene stays.
void drop_what_is_alone(const WorldFacets& facets, const std::vector<FoldedCells>& folded,
                        std::vector<std::vector<InCell>>& parts) {
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    Sieve seen(count), twice(count);
    for (const Plane& plane : facets.scene().planes)
        each_cell(plane, facets, [&](std::uint64_t cell) { twice.insert(cell); });
    for (const FoldedCells& cells : folded)
        for (const std::uint64_t cell : cells) twice.insert(cell);
    InCell last = {.facet = no_index};
    Index instance = 0;
    for (const auto& part : parts)
        for (const InCell& in : part) {
            while (in.facet >= facets.first_of(instance + 1)) ++instance;
            const bool follows = last.facet != no_index && in.cell == last.cell &&
                                 in.facet == last.facet + 1 &&
                                 last.facet >= facets.first_of(instance) &&
                                 share_corner(facets, instance, last.facet, in.facet);
            if (!follows && seen.insert(in.cell)) twice.insert(in.cell);
            last = in;
        }
    for (auto& part : parts)
        std::erase_if(part, [&](const InCell& in) { return !twice.contains(in.cell); });
}

// The last few facets, of which the next one may be a copy or the other half of a fold.
class Recent {
  public:
    bool lies_on_one(const WorldFacet& facet, Index instance) const {
        return std::ranges::any_of(facets_, [&](const auto& known) {
            return known.first == instance && overlap(known.second, facet);
        });
    }
    void add(const WorldFacet& facet, Index instance) {
        facets_[next_++ % facets_.size()] = {instance, facet};
    }

  private:
    std::array<std::pair<Index, WorldFacet>, 4> facets_ = {
        {{no_index, {}}, {no_index, {}}, {no_index, {}}, {no_index, {}}}};
    std::size_t next_ = 0;
};

std::vector<InCell> facets_by_cell(const WorldFacets& facets) {
    constexpr std::size_t block = std::size_t(1) << 15;
    std::vector<std::vector<InCell>> parts((facets.count() + block - 1) / block);
    std::vector<FoldedCells> folded(parts.size());
    for_each_block(facets.count(), [&](std::size_t first, std::size_t last) {
        std::vector<InCell>& part = parts[first / block];
        part.reserve(last - first);
        Index instance = facets.instance_of(Index(first));
        Recent recent;
        for (auto number = Index(first); number < last; ++number) {
            while (number >= facets.first_of(instance + 1)) ++instance;
            const Index in_mesh = number - facets.first_of(instance);
            facets.prefetch(instance, in_mesh + 16);
            const auto facet = facets.at(instance, in_mesh);
            if (!facet) continue;
            const bool folds = recent.lies_on_one(*facet, instance);
            recent.add(*facet, instance);
            each_cell(facet->normal, facet->normal.dot(facet->corners[0]), [&](std::uint64_t cell) {
                part.push_back({cell, number});
                if (folds) folded[first / block].push_back(cell);
            });
        }
    });
    drop_what_is_alone(facets, folded, parts);
    std::vector<InCell> all;
    std::size_t count = 0;
    for (const auto& part : parts) count += part.size();
    all.reserve(count);
    for (auto& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
        std::vector<InCell>().swap(part);
    }
    tbb::parallel_sort(all.begin(), all.end());
    return all;
}

// Calls visit(Run) for all cells with more than one facet.
template <class Visit>
void each_run(std::span<const InCell> all, Visit visit) {
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
        while (last < all.size() && all[last].cell == all[first].cell) ++last;
        if (last - first > 1) visit(all.subspan(first, last - first));
    }
}

// ---- patches ------------------------------------------------------------------------------------

// Sets of facets that are joined, each called by its first one.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), Index(0));
    }
    Index of(Index i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Index a, Index b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<Index> parent_;
};

struct AtVertex {
    Index instance = 0, vertex = 0, facet = 0;
    auto operator<=>(const AtVertex&) const = default;
};

// Joins the facets of a cell that share vertices.
void join_neighbours(const WorldFacets& facets, Run run, std::vector<AtVertex>& scratch,
                     Sets& sets) {
    scratch.clear();
    Index instance = facets.instance_of(run[0].facet);
    for (const InCell& in : run) {
        while (in.facet >= facets.first_of(instance + 1)) ++instance;
        const auto& triangle =
            facets.mesh_of(instance).triangles[in.facet - facets.first_of(instance)];
        for (const Index vertex : triangle) scratch.push_back({instance, vertex, in.facet});
    }
    std::sort(scratch.begin(), scratch.end());
    for (std::size_t i = 1; i < scratch.size(); ++i)
        if (scratch[i].vertex == scratch[i - 1].vertex &&
            scratch[i].instance == scratch[i - 1].instance)
            sets.join(scratch[i].facet, scratch[i - 1].facet);
}

// ---- overlaps -----------------------------------------------------------------------------------

class Overlaps {
  public:
    Overlaps(const WorldFacets& facets, const std::vector<Index>& patch)
        : facets_(facets), patch_(patch) {}

    // Finds what overlaps among the facets of a cell.
    void add(Run run) {
        const Index first = patch_[run[0].facet];
        if (std::ranges::all_of(run, [&](auto& in) { return patch_[in.facet] == first; })) return;
        placed_.clear();
        boxes_.clear();
        for (const InCell& in : run) {
            const Index instance = facets_.instance_of(in.facet);
            placed_.push_back(*facets_.at(instance, in.facet - facets_.first_of(instance)));
            boxes_.push_back(boxed(placed_.back(), boxes_.size(), patch_[in.facet]));
        }
        each_touching_pair(boxes_, [&](Index i, Index j) {
            add_pair(run[i].facet, run[j].facet, placed_[i], placed_[j]);
        });
    }

    // Finds the facets of a cell that lie in a plane of the scene.
    void add(const Plane& plane, const WorldFacet& in_it, Run run) {
        const Material& material = facets_.scene().materials[plane.material];
        const Side under = {.material = plane.material, .plain = true, .opaque = opaque(material)};
        for (const InCell& in : run) {
            const Side side = side_of(facets_, in.facet);
            const auto facet =
                facets_.at(side.instance, in.facet - facets_.first_of(side.instance));
            const bool there = std::ranges::all_of(facet->corners, [&](const Vec3& p) {
                return std::abs(in_it.height(p)) <= in_one_plane;
            });
            const bool facing = facet->normal.dot(in_it.normal) > 0;
            if (!there || !must_be_parted(under, side, facing)) continue;
            found_.push_back({no_index, patch_[in.facet], facing, !facing});
        }
    }

    // Two facets that were of one patch.
    void add_fold(Index a, Index b) {
        const auto at = [&](Index number) {
            const Index instance = facets_.instance_of(number);
            return *facets_.at(instance, number - facets_.first_of(instance));
        };
        add_pair(a, b, at(a), at(b), true);
    }

    // In an order that does not depend on the hashes of cells.
    std::vector<OverlappingPatches> found() {
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_;
    }

  private:
    void add_pair(Index a, Index b, const WorldFacet& at_a, const WorldFacet& at_b,
                  bool fold = false) {
        if (lies_on_patch(a, b)) return add_pair(b, a, at_b, at_a, fold);
        const Index lower = patch_[a], upper = patch_[b];
        const std::uint64_t both = std::uint64_t(lower) << 32 | upper;
        if (known_.contains(both) || !overlap(at_a, at_b)) return;
        const bool facing = at_a.normal.dot(at_b.normal) > 0;
        const Side below = side_of(facets_, a), above = side_of(facets_, b);
        if (!fold && !must_be_parted(below, above, facing)) return;
        known_.insert(both);
        // What shows one side goes towards that one.
        found_.push_back({lower, upper, facing, !facing && below.solid && !above.one_sided});
    }

    bool lies_on_patch(Index facet, Index other) {
        const Index a = facets_.instance_of(facet), b = facets_.instance_of(other);
        return a == b ? patch_[facet] > patch_[other] : lies_on(facets_, a, b);
    }

    const WorldFacets& facets_;
    const std::vector<Index>& patch_;
    std::unordered_set<std::uint64_t> known_;  // lower and upper patch of what was found
    std::vector<OverlappingPatches> found_;
    std::vector<WorldFacet> placed_;  // scratch
    std::vector<GroupedBox> boxes_;
};

}  // namespace

bool lies_on(const WorldFacets& facets, Index instance, Index other) {
    const auto rank = [&](Index i) {
        const Material& m = facets.material_of(i);
        const bool blended = !opaque(m) && !(m.alpha_map && m.alpha_map->cutoff);
        return std::pair(blended, i);
    };
    return rank(instance) > rank(other);
}

CoplanarPatches coplanar_patches(const WorldFacets& facets) {
    CoplanarPatches result;
    const MemoryClaim claim(times(facets.count(), 2 * sizeof(InCell) + 3 * sizeof(AtVertex)),
                            "facets in one plane");
    const std::vector<InCell> all = facets_by_cell(facets);
    if (all.empty()) return result;
    Sets patches(facets.count());
    std::vector<AtVertex> scratch;
    each_run(all, [&](Run run) { join_neighbours(facets, run, scratch, patches); });
    result.patch.resize(facets.count());
    for (Index i = 0; i < facets.count(); ++i) result.patch[i] = patches.of(i);
    Folds folds(facets, result.patch);
    std::vector<Index> members;
    each_run(all, [&](Run run) {
        members.clear();
        for (const InCell& in : run) members.push_back(in.facet);
        folds.add(members);
    });
    result.left = folds.too_many();
    const std::vector<std::pair<Index, Index>> folded = folds.found();
    result.torn = part_folds(facets, folded, result.patch);
    Overlaps overlaps(facets, result.patch);
    for (const auto& [a, b] : folded) overlaps.add_fold(a, b);
    each_run(all, [&](Run run) { overlaps.add(run); });
    for (const Plane& plane : facets.scene().planes) {
        const WorldFacet in_it = facet_in(plane, facets);
        each_cell(plane, facets, [&](std::uint64_t cell) {
            overlaps.add(plane, in_it, std::ranges::equal_range(all, cell, {}, &InCell::cell));
        });
    }
    result.overlaps = overlaps.found();
    return result;
}

}  // namespace penumbra
