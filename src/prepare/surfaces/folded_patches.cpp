#include "prepare/surfaces/folded_patches.h"

#include "prepare/surfaces/facet_sides.h"

#include <algorithm>
#include <map>
#include <unordered_map>

namespace penumbra {

namespace {

// Some ten seconds of work; a folded sheet has a few for each facet.
constexpr std::size_t most_folds = std::size_t(1) << 22;

// One patch that overlaps itself.
class FoldedPatch {
  public:
    FoldedPatch(const WorldFacets& facets, std::vector<Index> members)
        : members_(std::move(members)), first_(facets.first_of(facets.instance_of(members_[0]))),
          triangles_(facets.mesh_of(facets.instance_of(members_[0])).triangles) {
        for (const Index facet : members_)
            for (const Index vertex : triangles_[facet - first_]) at_[vertex].push_back(facet);
    }

    void must_not_join(Index a, Index b) {
        apart_[a].push_back(b);
        apart_[b].push_back(a);
    }

    // Grows pieces from the first facets that are left, through shared vertices.
    std::unordered_map<Index, Index> pieces() const {
        std::unordered_map<Index, Index> piece;
        for (const Index start : members_)
            if (piece.emplace(start, start).second) grow(start, piece);
        return piece;
    }

  private:
    void grow(Index start, std::unordered_map<Index, Index>& piece) const {
        std::vector<Index> reached = {start};
        for (std::size_t i = 0; i < reached.size(); ++i)
            for (const Index vertex : triangles_[reached[i] - first_])
                for (const Index next : at_.at(vertex)) {
                    if (piece.contains(next) || lies_on(next, start, piece)) continue;
                    piece[next] = start;
                    reached.push_back(next);
                }
    }

    bool lies_on(Index facet, Index wanted, const std::unordered_map<Index, Index>& piece) const {
        const auto apart = apart_.find(facet);
        return apart != apart_.end() && std::ranges::any_of(apart->second, [&](Index other) {
                   const auto found = piece.find(other);
                   return found != piece.end() && found->second == wanted;
               });
    }

    std::vector<Index> members_;  // in the order of the file
    Index first_;                 // facet of the instance
    const std::vector<std::array<Index, 3>>& triangles_;
    std::unordered_map<Index, std::vector<Index>> at_, apart_;
};

Index copy_vertex(Mesh& mesh, Index vertex) {
    const auto copy = [&](auto& values) {
        if (values.empty()) return;
        const auto value = values[vertex];
        values.push_back(value);
    };
    copy(mesh.positions);
    copy(mesh.normals);
    copy(mesh.texcoords);
    copy(mesh.colors);
    copy(mesh.alphas);
    copy(mesh.tangents);
    return Index(mesh.positions.size() - 1);
}

}  // namespace

bool Folds::too_many() const { return found_.size() >= most_folds; }

std::vector<std::pair<Index, Index>> Folds::found() {
    std::ranges::sort(found_);
    // A pair may be in two cells.
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
}

void Folds::add(const std::vector<Index>& facets) {
    members_.clear();
    for (const Index facet : facets) members_.emplace_back(patch_[facet], facet);
    std::ranges::sort(members_);
    for (std::size_t first = 0, last = 0; first < members_.size(); first = last) {
        while (last < members_.size() && members_[last].first == members_[first].first) ++last;
        if (last - first > 1) add_patch(std::span(members_).subspan(first, last - first));
    }
}

void Folds::add_patch(std::span<const Member> members) {
    placed_.clear();
    boxes_.clear();
    placed_.reserve(members.size());
    boxes_.reserve(members.size());
    const Index instance = facets_.instance_of(members[0].second);
    for (std::size_t i = 0; i < members.size(); ++i) {
        placed_.push_back(*facets_.at(instance, members[i].second - facets_.first_of(instance)));
        boxes_.push_back(boxed(placed_.back(), i, Index(i)));
    }
    each_touching_pair(boxes_, [&](Index i, Index j) {
        if (too_many() || !overlap(placed_[i], placed_[j])) return;
        const auto [a, b] = std::minmax(members[i].second, members[j].second);
        const bool facing = placed_[i].normal.dot(placed_[j].normal) > 0;
        if (must_be_parted_there(a, b, facing)) found_.emplace_back(a, b);
    });
}

// A sheet that is folded onto itself shows two parts of it at once, and not one from either side.
bool Folds::must_be_parted_there(Index a, Index b, bool facing) const {
    const Side below = side_of(facets_, a), above = side_of(facets_, b);
    if (must_be_parted(below, above, facing)) return true;
    if (facing || (below.plain && above.plain)) return false;
    const Index instance = facets_.instance_of(a), first = facets_.first_of(instance);
    const auto& triangles = facets_.mesh_of(instance).triangles;
    return !std::ranges::is_permutation(triangles[a - first], triangles[b - first]);
}

std::vector<TornFacet> part_folds(const WorldFacets& facets,
                                  const std::vector<std::pair<Index, Index>>& overlaps,
                                  std::vector<Index>& patch) {
    std::map<Index, std::vector<Index>> members;
    for (const auto& [a, b] : overlaps) members[patch[a]];
    if (members.empty()) return {};
    for (Index i = 0; i < patch.size(); ++i)
        if (const auto found = members.find(patch[i]); found != members.end())
            found->second.push_back(i);
    std::map<Index, FoldedPatch> folded;
    for (auto& [name, list] : members) folded.emplace(name, FoldedPatch(facets, std::move(list)));
    for (const auto& [a, b] : overlaps) folded.at(patch[a]).must_not_join(a, b);
    std::vector<TornFacet> torn;
    for (const auto& [name, folds] : folded) {
        const Index instance = facets.instance_of(name), first = facets.first_of(instance);
        const Index mesh = facets.scene().instances[instance].mesh;
        for (const auto& [facet, piece] : folds.pieces()) {
            patch[facet] = piece;
            if (piece != name) torn.push_back({mesh, facet - first, piece - first});
        }
    }
    return torn;
}

void tear(Scene& scene, std::vector<TornFacet> torn) {
    std::ranges::sort(torn);
    std::map<std::pair<Index, Index>, Index> copies;  // of a vertex for a piece
    for (std::size_t i = 0; i < torn.size(); ++i) {
        const bool fresh = i == 0 || torn[i].mesh != torn[i - 1].mesh;
        // Instances of one mesh have the same folds.
        if (!fresh && torn[i].facet == torn[i - 1].facet) continue;
        if (fresh) copies.clear();
        Mesh& mesh = scene.meshes[torn[i].mesh];
        for (Index& vertex : mesh.triangles[torn[i].facet]) {
            const auto [copy, made] = copies.try_emplace({torn[i].piece, vertex}, 0);
            if (made) copy->second = copy_vertex(mesh, vertex);
            vertex = copy->second;
        }
    }
}

}  // namespace penumbra
