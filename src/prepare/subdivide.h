// Meshes whose facets are halved where more detail is wanted.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

/// A mesh that stays conforming while it is divided: facets that share an edge in space share its
/// midpoint, to the bit, even where their vertices differ (at seams). Facets without area are left
/// out. All vertex data are interpolated linearly and not normalised again, so that at any depth
/// they are those of a point of the original facet.
class Subdivision {
  public:
    explicit Subdivision(Mesh mesh);

    const Mesh& mesh() const { return mesh_; }
    Mesh& mesh() { return mesh_; }

    /// Vertices at the same point in space have the same place, below places().
    Index place(Index vertex) const { return place_[vertex]; }
    Index places() const { return places_; }

    /// Takes a step towards halving `facet`: halves the edge where the path of ever longer
    /// neighbouring edges ends (M.-C. Rivara, 1997: longest-edge propagation), which keeps facets
    /// from becoming slivers. `changed` receives the facets that are smaller now; new ones are at
    /// the end of mesh().triangles.
    void divide(Index facet, std::vector<Index>& changed);

  private:
    // An edge of a facet: 3 x facet + corner, from that corner to the next.
    using Side = Index;

    Mesh mesh_;
    std::vector<Index> place_;  // of vertices
    std::vector<Side> next_;    // another side on the same edge, round in a ring
    Index places_ = 0;

    Index vertex(Side side) const { return mesh_.triangles[side / 3][side % 3]; }
    static Side after(Side side) { return side % 3 == 2 ? side - 2 : side + 1; }
    Index start(Side side) const { return place_[vertex(side)]; }
    Index end(Side side) const { return place_[vertex(after(side))]; }
    bool longer(Side a, Side b) const;
    Side longest(Index facet) const;
    Side end_of_path(Index facet) const;
    void link(const std::vector<Side>& ring);
    void replace(Side old_side, Side new_side);
    Index midpoint(Index a, Index b);
    Side halve(Side side, Index middle);
};

}  // namespace penumbra
