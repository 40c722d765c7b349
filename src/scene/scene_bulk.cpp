#include "scene/scene_bulk.h"

#include <cassert>

namespace penumbra {

namespace {

Texture without_samples(const Texture& texture) {
    const auto& [name, raster, srgb, bilinear, wrap_u, wrap_v] = texture;
    return {name, {}, srgb, bilinear, wrap_u, wrap_v};
}

}  // namespace

// Both take the structs apart by name and make them from all their members, so that a new one is an
// error here until it is kept.
Scene without_bulk(const Scene& scene) {
    const auto& [materials, textures, meshes, instances, spheres, planes, lights, cameras, camera,
                 background, sky, mirror_sky, environment, ambient] = scene;
    Scene small = {materials, {},     {},         instances, spheres,    planes,      lights,
                   cameras,   camera, background, sky,       mirror_sky, environment, ambient};
    for (const Texture& texture : textures) small.textures.push_back(without_samples(texture));
    return small;
}

void restore_all_but_bulk(Scene& scene, const Scene& kept) {
    std::vector<Mesh> meshes = std::move(scene.meshes);
    std::vector<Texture> textures = std::move(scene.textures);
    scene = kept;
    assert(textures.size() >= scene.textures.size());
    scene.meshes = std::move(meshes);
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        scene.textures[i].raster = std::move(textures[i].raster);
}

}  // namespace penumbra
