// Which facets meet in a point, though each may have vertices of its own there.
#pragma once

#include "penumbra/scene.h"

#include <span>
#include <vector>

namespace penumbra {

class MeshCorners {
  public:
    explicit MeshCorners(const Mesh& mesh);

    /// Those with a corner in the place of the vertex.
    std::span<const Index> facets_at(Index vertex) const {
        const Index place = places_[vertex];
        return std::span(facets_).subspan(first_[place], first_[place + 1] - first_[place]);
    }

  private:
    std::vector<Index> places_;  // of vertices: the first vertex that is there
    std::vector<Index> first_;   // of a place's facets, and behind the last one's
    std::vector<Index> facets_;
};

}  // namespace penumbra
