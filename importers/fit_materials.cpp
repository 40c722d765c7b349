#include "importers/fit_materials.h"

#include <fmt/format.h>

#include <map>
#include <variant>

namespace penumbra {

namespace {

bool has_image(const Scene& scene, Index material) {
    return material < scene.materials.size() &&
           std::holds_alternative<ImageMap>(scene.materials[material].pattern);
}

}  // namespace

void drop_images_without_texcoords(Imported& result) {
    Scene& scene = result.scene;
    std::map<Index, Index> plain;
    for (Mesh& mesh : scene.meshes) {
        if (!mesh.texcoords.empty() || mesh.triangles.empty() || !has_image(scene, mesh.material))
            continue;
        const Material original = scene.materials[mesh.material];
        const auto [entry, fresh] = plain.emplace(mesh.material, Index(scene.materials.size()));
        if (fresh) {
            scene.materials.push_back(original);
            scene.materials.back().pattern = {};
        }
        mesh.material = entry->second;
        result.losses.push_back(
            {Loss::dropped, mesh.name.empty() ? "a mesh" : "mesh '" + mesh.name + "'",
             fmt::format("has no texture coordinates for the texture of material '{}'; its plain "
                         "colour is used",
                         original.name)});
    }
}

void drop_maps_of_translucent_materials(Imported& result) {
    for (Material& m : result.scene.materials) {
        if (m.opacity == 1 || (!m.specular_lobes && !m.emission_map && !m.diffuse_transmission_map))
            continue;
        m.specular_lobes.reset();
        m.emission_map.reset();
        m.diffuse_transmission_map.reset();
        result.losses.push_back({Loss::dropped, fmt::format("material '{}'", m.name),
                                 "its gloss and emission images are dropped: it is translucent"});
    }
}

}  // namespace penumbra
