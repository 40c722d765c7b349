// A square with a normal map.
#pragma once

#include "support/small_scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace test {

// An 8-bit normal map; `normal` gives the unit normal at texture coordinates.
inline Texture map_of(int size, const std::function<Vec3(const Vec2&)>& normal) {
    Texture texture = {.name = "map", .srgb = false};
    texture.raster = {.width = size, .height = size, .channels = 3};
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const Vec3 n = normal(Vec2((column + 0.5) / size, 1 - (row + 0.5) / size)).normalized();
            for (int c = 0; c < 3; ++c)
                texture.raster.data.push_back(std::byte(std::lround((n[c] * 0.5 + 0.5) * 255)));
        }
    return texture;
}

inline Vec3 bumps(const Vec2& t) {
    const double turn = 4 * std::numbers::pi;  // repeats at the edges
    return Vec3(0.5 * std::sin(t.x * turn), 0.5 * std::sin(t.y * turn), 1).normalized();
}

// A unit square facing +z whose image stands upright, with a normal map over it.
inline Scene mapped_square(const Texture& map, float scale = 1) {
    Scene scene = empty_scene();
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    scene.meshes[0].texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.meshes[0].normals.assign(4, Vec3f(0, 0, 1));
    scene.textures = {map};
    scene.materials[0].normal_map = NormalMap{.map = {.texture = 0}, .scale = scale};
    return scene;
}

inline double angle(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0));
}

}  // namespace test
