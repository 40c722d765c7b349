// What a normal map makes of a mesh's normals.
#pragma once

#include "scene/texture/texture_lookup.h"

#include "penumbra/scene.h"

namespace penumbra {

/// The directions that a normal map's texels are relative to; they need not be unit, nor need the
/// tangent be perpendicular to the normal.
struct TangentFrame {
    Vec3 normal = {0, 0, 1}, tangent = {1, 0, 0};
    double handedness = 1;  ///< its sign is that of the bitangent
};

/// The unit normal of `map` at the mesh's texture coordinates; `lookup` is that of its texture.
Vec3 perturbed_normal(const NormalMap& map, const TextureLookup& lookup, const TangentFrame& frame,
                      const Vec2& texcoord);

/// The same where the corners of a facet have these weights; the mesh has normals and tangents.
Vec3 perturbed_normal(const NormalMap& map, const TextureLookup& lookup, const Mesh& mesh,
                      Index facet, const Vec3& weights);

/// Whether perturbed_normal() has what it needs of the mesh.
inline bool has_tangent_frames(const Mesh& mesh) {
    return !mesh.tangents.empty() && !mesh.normals.empty() && !mesh.texcoords.empty();
}

/// Gives every facet vertices of its own with the facet's normal, on the side of the normals that
/// the mesh has.
void give_facet_normals(Mesh& mesh);

/// Whether the material's normal map can be laid over the mesh.
bool has_normal_map(const Scene& scene, const Mesh& mesh);

/// compute_tangents() for every mesh with a normal map that has none.
void complete_tangents(Scene& scene);

}  // namespace penumbra
