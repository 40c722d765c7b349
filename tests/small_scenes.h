// Small scenes that tests build in code.
#pragma once

#include "penumbra/scene.h"

#include <initializer_list>

namespace test {

using namespace penumbra;

/// A matte material without ambient light: what is in full shadow is black.
inline Material matte(float albedo = 1) {
    return {
        .name = "matte", .color = Color(albedo), .ambient = Color(0), .diffuse = 1, .specular = 0};
}

/// An empty scene in working units with one matte material and a camera at (0, 0, 10).
inline Scene empty_scene() {
    Scene scene;
    scene.materials = {matte()};
    scene.cameras = {{.name = "eye", .position = {0, 0, 10}}};
    scene.camera = 0;
    return scene;
}

inline void add_mesh(Scene& scene, std::vector<Vec3f> positions,
                     std::vector<std::array<Index, 3>> triangles, Index material = 0) {
    Mesh mesh = {
        .name = "mesh", .positions = std::move(positions), .triangles = std::move(triangles)};
    mesh.material = material;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({.name = "mesh", .mesh = Index(scene.meshes.size() - 1)});
}

/// Two facets that span the corners a, b, c, d in turn.
inline void add_quad(Scene& scene, Vec3f a, Vec3f b, Vec3f c, Vec3f d, Index material = 0) {
    add_mesh(scene, {a, b, c, d}, {{0, 1, 2}, {0, 2, 3}}, material);
}

/// The scene as it stands, without a change of units.
inline NormalisedScene as_is(Scene scene) { return {.scene = std::move(scene)}; }

}  // namespace test
