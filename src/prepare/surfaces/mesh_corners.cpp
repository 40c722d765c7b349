#include "prepare/surfaces/mesh_corners.h"

#include "prepare/weld.h"

#include <numeric>

namespace penumbra {

MeshCorners::MeshCorners(const Mesh& mesh)
    : places_(weld(mesh.positions.size(),
                   [&](Index i) {
                       const Vec3f& p = mesh.positions[i];
                       return std::array{p.x, p.y, p.z};
                   })),
      first_(mesh.positions.size() + 2, 0), facets_(3 * mesh.triangles.size()) {
    // Counted two places ahead, so that filling leaves each beginning where it belongs.
    for (const auto& triangle : mesh.triangles)
        for (const Index vertex : triangle) ++first_[places_[vertex] + 2];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    for (Index facet = 0; facet < mesh.triangles.size(); ++facet)
        for (const Index vertex : mesh.triangles[facet])
            facets_[first_[places_[vertex] + 1]++] = facet;
}

}  // namespace penumbra
