// What meshes have for each vertex, in one place.
#pragma once

#include "penumbra/scene.h"

#include <cstddef>
#include <type_traits>

namespace penumbra {

/// Calls visit(values) for every per-vertex vector of a Mesh; some of them may be empty. The mesh
/// is taken apart by name, so that a new member is an error here until it has been looked at.
template <class AnyMesh, class Visit>
void each_vertex_array(AnyMesh& mesh, Visit visit) {
    auto& [name, positions, normals, texcoords, colors, alphas, tangents, triangles, material] =
        mesh;
    visit(positions);
    visit(normals);
    visit(texcoords);
    visit(colors);
    visit(alphas);
    visit(tangents);
}

/// Bytes that its vectors take.
inline std::size_t memory_of(const Mesh& mesh) {
    std::size_t bytes = mesh.triangles.size() * sizeof mesh.triangles[0];
    each_vertex_array(mesh, [&](const auto& values) { bytes += values.size() * sizeof values[0]; });
    return bytes;
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
