#include "importers/fit_materials.h"

#include "importers/shared/formats.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <variant>
#include <vector>

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
        if (m.opacity == 1) continue;
        std::vector<std::string> dropped;
        const auto drop = [&](auto& map, const char* name) {
            if (map) dropped.emplace_back(name);
            map.reset();
        };
        drop(m.specular_lobes, "specular lobes");
        drop(m.diffuse_transmission_map, "diffuse transmission map");
        if (dropped.empty()) continue;
        result.losses.push_back(
            {Loss::dropped, fmt::format("material '{}'", m.name),
             fmt::format("is shown without its {}: it is translucent", listed(dropped, "and"))});
    }
}

}  // namespace penumbra
