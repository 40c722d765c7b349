#include "scene/normal_map.h"

#include "scene/vertex_arrays.h"

#include "penumbra/light_model.h"
#include "penumbra/prepare.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra {

namespace {

// Tangents that were made for interpolated normals do not suit flat facets.
bool is_flat(const Scene& scene, const Mesh& mesh) {
    return mesh.normals.empty() || !scene.materials[mesh.material].smooth;
}

Vec3 facet_normal(const Mesh& mesh, const std::array<Index, 3>& facet) {
    const auto& [a, b, c] = facet;
    const Vec3 first(mesh.positions[a]);
    Vec3 normal =
        (Vec3(mesh.positions[b]) - first).cross(Vec3(mesh.positions[c]) - first).normalized();
    if (mesh.normals.empty()) return normal;
    const Vec3 side = Vec3(mesh.normals[a]) + Vec3(mesh.normals[b]) + Vec3(mesh.normals[c]);
    return normal.dot(side) < 0 ? -normal : normal;
}

}  // namespace

Vec3 perturbed_normal(const NormalMap& map, const TextureLookup& lookup, const TangentFrame& frame,
                      const Vec2& texcoord) {
    const Vec3 n = frame.normal.normalized();
    const Vec3 t = (frame.tangent - n * n.dot(frame.tangent)).normalized();
    const Vec3 b = n.cross(t) * (frame.handedness < 0 ? -1.0 : 1.0);
    const Vec2 uv = map_texcoord(map.map, texcoord);
    // glTF 2.0, section 3.9.3: [0, 1] holds [-1, 1]; scale is of x and y alone.
    const Vec3 texel = Vec3(sample(lookup, uv.x, uv.y)) * 2 - Vec3(1);
    const Vec3 bent = (t * texel.x + b * texel.y) * double(map.scale) + n * texel.z;
    return bent == Vec3(0) ? n : bent.normalized();
}

Vec3 perturbed_normal(const NormalMap& map, const TextureLookup& lookup, const Mesh& mesh,
                      Index facet, const Vec3& weights) {
    const auto& [a, b, c] = mesh.triangles[facet];
    const auto mix = [&](const auto& x, const auto& y, const auto& z) {
        return x * weights.x + y * weights.y + z * weights.z;
    };
    const std::vector<Vec3f>& n = mesh.normals;
    const std::vector<Vec2f>& t = mesh.texcoords;
    const Tangent &ta = mesh.tangents[a], &tb = mesh.tangents[b], &tc = mesh.tangents[c];
    const TangentFrame frame = {.normal = mix(Vec3(n[a]), Vec3(n[b]), Vec3(n[c])),
                                .tangent =
                                    mix(Vec3(ta.direction), Vec3(tb.direction), Vec3(tc.direction)),
                                .handedness = mix(ta.handedness, tb.handedness, tc.handedness)};
    return perturbed_normal(map, lookup, frame, mix(Vec2(t[a]), Vec2(t[b]), Vec2(t[c])));
}

void give_facet_normals(Mesh& mesh) {
    std::vector<Index> chosen;
    std::vector<Vec3f> normals;
    chosen.reserve(mesh.triangles.size() * 3);
    normals.reserve(mesh.triangles.size() * 3);
    for (auto& facet : mesh.triangles) {
        const Vec3f normal(facet_normal(mesh, facet));
        for (Index& corner : facet) {
            chosen.push_back(corner);
            normals.push_back(normal);
            corner = Index(chosen.size() - 1);
        }
    }
    mesh.tangents.clear();
    mesh.normals.clear();
    choose_vertices(mesh, chosen);
    mesh.normals = std::move(normals);
}

bool has_normal_map(const Scene& scene, const Mesh& mesh) {
    return mesh.material < scene.materials.size() && !mesh.texcoords.empty() &&
           !mesh.triangles.empty() && scene.materials[mesh.material].normal_map.has_value();
}

void complete_tangents(Scene& scene) {
    for (Mesh& mesh : scene.meshes) {
        if (!has_normal_map(scene, mesh)) continue;
        if (is_flat(scene, mesh)) give_facet_normals(mesh);
        if (mesh.tangents.empty())
            compute_tangents(mesh, scene.materials[mesh.material].normal_map->map);
    }
}

Losses drop_normal_maps(Scene& scene) {
    Losses losses;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        if (!material.normal_map) continue;
        material.normal_map.reset();
        losses.push_back({Loss::dropped,
                          material.name.empty() ? fmt::format("material {}", i) : material.name,
                          "its normal map is left out"});
    }
    return losses;
}

}  // namespace penumbra
