// Patches that lie on themselves: folded sheets, and facets that a mesh has twice.
#pragma once

#include "prepare/surfaces/facet_overlaps.h"
#include "prepare/surfaces/world_facets.h"

#include <span>
#include <utility>
#include <vector>

namespace penumbra {

/// Finds the facets that lie on others of their own patch and must be parted from them.
class Folds {
  public:
    /// `patch` has that of every facet.
    Folds(const WorldFacets& facets, const std::vector<Index>& patch)
        : facets_(facets), patch_(patch) {}

    /// Some facets that may lie in one plane.
    void add(const std::vector<Index>& facets);

    /// Whether it gave up.
    bool too_many() const;
    /// Sorted pairs, the first facet first.
    std::vector<std::pair<Index, Index>> found();

  private:
    using Member = std::pair<Index, Index>;  // patch, facet

    void add_patch(std::span<const Member> members);
    bool must_be_parted_there(Index a, Index b, bool facing) const;

    const WorldFacets& facets_;
    const std::vector<Index>& patch_;
    std::vector<std::pair<Index, Index>> found_;
    std::vector<Member> members_;  // scratch
    std::vector<WorldFacet> placed_;
    std::vector<GroupedBox> boxes_;
};

/// A facet that is taken from its patch, as it lies on it, and becomes part of another one.
struct TornFacet {
    Index mesh = 0, facet = 0;
    Index piece = 0;  ///< of the mesh: the first facet of the new patch
    auto operator<=>(const TornFacet&) const = default;
};

/// Parts patches into such as do not overlap themselves, each called by its first facet. `patch`
/// has that of every facet; `overlaps` are the pairs of facets of one patch that must be parted.
std::vector<TornFacet> part_folds(const WorldFacets& facets,
                                  const std::vector<std::pair<Index, Index>>& overlaps,
                                  std::vector<Index>& patch);

/// Gives torn facets vertices of their own, so that they can be lifted by themselves.
void tear(Scene& scene, std::vector<TornFacet> torn);

}  // namespace penumbra
