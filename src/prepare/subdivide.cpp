#include "prepare/subdivide.h"

#include "prepare/weld.h"
#include "scene/vertex_arrays.h"

#include <tuple>
#include <utility>

namespace penumbra {

namespace {

std::vector<Index> places_of(const Mesh& mesh) {
    return weld(mesh.positions.size(), [&](Index i) {
        const Vec3f& p = mesh.positions[i];
        return std::array<float, 3>{p.x, p.y, p.z};
    });
}

template <class T>
void append_mean(std::vector<T>& values, Index a, Index b) {
    if (!values.empty()) values.push_back((values[a] + values[b]) * 0.5F);
}

void append_mean(std::vector<Tangent>& tangents, Index a, Index b) {
    if (tangents.empty()) return;
    const Tangent &s = tangents[a], &t = tangents[b];
    tangents.push_back({(s.direction + t.direction) * 0.5F, (s.handedness + t.handedness) * 0.5F});
}

}  // namespace

Subdivision::Subdivision(Mesh mesh)
    : mesh_(std::move(mesh)), place_(places_of(mesh_)), places_(Index(place_.size())) {
    std::erase_if(mesh_.triangles, [&](const std::array<Index, 3>& t) {
        return place_[t[0]] == place_[t[1]] || place_[t[1]] == place_[t[2]] ||
               place_[t[2]] == place_[t[0]];
    });
    struct Entry {
        Index low, high;
        Side side;
        bool operator<(const Entry& o) const {
            return std::tie(low, high, side) < std::tie(o.low, o.high, o.side);
        }
    };
    const std::size_t sides = mesh_.triangles.size() * 3;
    std::vector<Entry> entries;
    entries.reserve(sides);
    for (Side s = 0; s < sides; ++s) {
        const auto [low, high] = std::minmax({start(s), end(s)});
        entries.push_back({low, high, s});
    }
    std::sort(entries.begin(), entries.end());
    next_.resize(sides);
    for (std::size_t i = 0, first = 0; i < sides; ++i) {
        const bool last = i + 1 == sides || entries[i + 1].low != entries[first].low ||
                          entries[i + 1].high != entries[first].high;
        next_[entries[i].side] = entries[last ? first : i + 1].side;
        if (last) first = i + 1;
    }
}

// A strict order of edges, the same from all of their facets, so that paths end.
bool Subdivision::longer(Side a, Side b) const {
    const auto key = [&](Side s) {
        const auto [low, high] = std::minmax({start(s), end(s)});
        const Vec3 difference =
            Vec3(mesh_.positions[vertex(s)]) - Vec3(mesh_.positions[vertex(after(s))]);
        return std::tuple(difference.length2(), low, high);
    };
    return key(a) > key(b);
}

Subdivision::Side Subdivision::longest(Index facet) const {
    Side best = 3 * facet;
    for (Side s = best + 1; s < 3 * facet + 3; ++s)
        if (longer(s, best)) best = s;
    return best;
}

Subdivision::Side Subdivision::end_of_path(Index facet) const {
    Side here = longest(facet);
    for (Side s = next_[here]; s != here; s = next_[s])
        if (const Side other = longest(s / 3); longer(other, here)) s = here = other;
    return here;
}

void Subdivision::link(const std::vector<Side>& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) next_[ring[i]] = ring[(i + 1) % ring.size()];
}

void Subdivision::replace(Side old_side, Side new_side) {
    Side before = old_side;
    while (next_[before] != old_side) before = next_[before];
    next_[new_side] = before == old_side ? new_side : next_[old_side];
    if (before != old_side) next_[before] = new_side;
}

Index Subdivision::midpoint(Index a, Index b) {
    each_vertex_array(mesh_, [&](auto& values) { append_mean(values, a, b); });
    place_.push_back(places_);
    return Index(mesh_.positions.size() - 1);
}

// The facet keeps the first half of `side`; returns the second half, of a new facet.
Subdivision::Side Subdivision::halve(Side side, Index middle) {
    const auto facet = Index(mesh_.triangles.size());
    const Side second = 3 * facet, far = after(side);
    mesh_.triangles.push_back({middle, vertex(far), vertex(after(far))});
    mesh_.triangles[far / 3][far % 3] = middle;
    next_.resize(next_.size() + 3);
    replace(far, second + 1);
    link({far, second + 2});  // the new edge between both
    return second;
}

void Subdivision::divide(Index facet, std::vector<Index>& changed) {
    const Side whole = end_of_path(facet);
    std::vector<Side> sides = {whole};
    for (Side s = next_[whole]; s != whole; s = next_[s]) sides.push_back(s);

    const Index first_place = start(whole);
    std::vector<std::pair<std::pair<Index, Index>, Index>> made;  // of two vertices: the midpoint
    std::vector<Side> low, high;                                  // both halves of the edge
    for (const Side s : sides) {
        const std::pair<Index, Index> ends = std::minmax({vertex(s), vertex(after(s))});
        auto found = std::find_if(made.begin(), made.end(),
                                  [&](const auto& entry) { return entry.first == ends; });
        if (found == made.end())
            found = made.insert(made.end(), {ends, midpoint(ends.first, ends.second)});
        const Side second = halve(s, found->second);
        const bool forward = start(s) == first_place;
        low.push_back(forward ? s : second);
        high.push_back(forward ? second : s);
        changed.push_back(s / 3);
        changed.push_back(second / 3);
    }
    link(low);
    link(high);
    ++places_;
}

}  // namespace penumbra
