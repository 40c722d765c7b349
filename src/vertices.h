// What meshes have for each vertex, in one place.
#pragma once

#include "penumbra/scene.h"

#include <type_traits>

namespace penumbra {

/// Calls visit(values) for every per-vertex vector of a Mesh; some of them may be empty.
template <class AnyMesh, class Visit>
void each_vertex_array(AnyMesh& mesh, Visit visit) {
    visit(mesh.positions);
    visit(mesh.normals);
    visit(mesh.texcoords);
    visit(mesh.colors);
    visit(mesh.alphas);
    visit(mesh.tangents);
}

/// Makes the vertices those `chosen` ones, in that order; a vertex may be chosen several times.
inline void choose_vertices(Mesh& mesh, const std::vector<Index>& chosen) {
    each_vertex_array(mesh, [&](auto& values) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> picked;
        picked.reserve(chosen.size());
        for (const Index vertex : chosen) picked.push_back(values[vertex]);
        values = std::move(picked);
    });
}

}  // namespace penumbra
