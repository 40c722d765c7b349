// Small scenes that tests build in code.
#pragma once

#include "penumbra/prepare.h"
#include "penumbra/scene.h"

#include <cmath>
#include <initializer_list>
#include <variant>

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

/// Everything in it as far away from where it was.
inline void move_by(Scene& scene, const Vec3& offset) {
    for (Instance& i : scene.instances)
        for (int axis = 0; axis < 3; ++axis) i.transform[3][axis] += offset[axis];
    for (Sphere& s : scene.spheres) s.center += offset;
    for (Plane& p : scene.planes) p.point += offset;
    for (Light& l : scene.lights) {
        l.position += offset;
        l.penumbra.target += offset;
    }
    for (Camera& c : scene.cameras) c.position += offset;
    for (Material& m : scene.materials) {
        if (auto* checker = std::get_if<Checker>(&m.pattern)) checker->origin += offset;
        if (auto* noise = std::get_if<Noise>(&m.pattern)) noise->origin += offset;
    }
}

/// The share of pixels with a channel that is off by more than `tolerance`.
inline double share_off(const Image& a, const Image& b, float tolerance = 1e-4F) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const Color d = a.pixels[i] - b.pixels[i];
        // NaN is off.
        const bool same =
            std::abs(d.x) <= tolerance && std::abs(d.y) <= tolerance && std::abs(d.z) <= tolerance;
        count += same ? 0 : 1;
    }
    return double(count) / double(a.pixels.size());
}

/// The scene as it stands, without a change of units.
inline NormalisedScene as_is(Scene scene) { return {.scene = std::move(scene)}; }

}  // namespace test
