// Which meshes show a texture of its own at every vertex: POV-Ray's way to vertex colours. What
// such a texture has of normals lies in the space of the mesh, that of others in world space.
#pragma once

#include "penumbra/scene.h"

namespace penumbra {

struct VertexTextures {
    bool tinted = false;  ///< by vertex colours
    bool faded = false;   ///< by Mesh::alphas
    bool any() const { return tinted || faded; }
};

/// `material` is that of the mesh.
VertexTextures vertex_textures(const Mesh& mesh, const Material& material);

}  // namespace penumbra
