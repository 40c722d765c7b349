// [material.NAME] -> Material.
#include "base/file.h"
#include "base/text/suggest.h"
#include "base/text/text.h"
#include "importers/shared/file_names.h"
#include "importers/sidecar/sidecar.h"

#include "penumbra/light_model.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::pair<const char*, Sides> sides[] = {{"both", Sides::both}, {"front", Sides::front}};

// The pattern that `material` has, or the default one of its kind.
template <class Kind>
Kind pattern_of(const Material& material) {
    const auto* present = std::get_if<Kind>(&material.pattern);
    return present != nullptr ? *present : Kind{};
}

// texture = "wood.png", or { file = "wood.png", size = 2 }.
bool read_texture(Section& section, Material& material, Scene& scene, TextureFiles& files) {
    if (!section.has("texture")) return false;
    auto map = pattern_of<ImageMap>(material);
    std::string file;
    if (section.is_table("texture")) {
        Section inner = *section.table("texture");
        inner.read("file", file);
        inner.read("size", map.size, positive);
        inner.finish();
        if (map.texture == no_index) inner.require("file");
    } else {
        section.read("texture", file);
    }
    if (!file.empty()) map.texture = load_texture(section, "texture", file, scene, files);
    if (map.texture == no_index) section.reject("texture", "must name a file");
    material.pattern = map;
    return true;
}

bool read_checker(Section& section, Material& material) {
    auto inner = section.table("checker");
    if (!inner) return false;
    auto checker = pattern_of<Checker>(material);
    inner->read_colors("colors", checker.colors);
    inner->read("size", checker.size, positive);
    inner->finish();
    material.pattern = checker;
    return true;
}

bool read_noise(Section& section, Material& material) {
    auto inner = section.table("noise");
    if (!inner) return false;
    auto noise = pattern_of<Noise>(material);
    inner->read_colors("colors", noise.colors);
    inner->read("size", noise.size, positive);
    inner->read("octaves", noise.octaves, {.low = 1, .high = 10});
    inner->finish();
    material.pattern = noise;
    return true;
}

void read_pigment(Section& section, Material& material, Scene& scene, TextureFiles& files) {
    const bool colored = section.read_color("color", material.color);
    const bool textured = read_texture(section, material, scene, files);
    const bool checkered = read_checker(section, material);
    const bool noisy = read_noise(section, material);
    if (textured + checkered + noisy > 1)
        section.fail("texture", section.title() + " may have one of texture, checker and noise");
    // A colour is a texture's factor, but the other patterns know no colour beside their own.
    if (colored && !checkered && !noisy && !std::holds_alternative<ImageMap>(material.pattern))
        material.pattern = {};
}

void read_mirrors(Section& section, int& mirrors) {
    section.read("mirrors", mirrors, {.low = 1, .high = 32});
    if (!is_mirror_count(mirrors)) section.reject("mirrors", "must be 1, 7, 13, 19 or 32");
}

// absorption = { color = [0.9, 0.5, 0.5], distance = 1 }, or false.
void read_absorption(Section& section, Material& material) {
    if (section.is_false("absorption")) {
        material.absorption.reset();
        return;
    }
    auto inner = section.table("absorption");
    if (!inner) return;
    Absorption absorption = material.absorption.value_or(Absorption{});
    inner->read_color("color", absorption.color);
    for (int c = 0; c < 3; ++c)
        if (!(absorption.color[c] > 0 && absorption.color[c] <= 1))
            inner->reject("color", "must have channels above 0 and not above 1");
    inner->read("distance", absorption.distance, positive);
    inner->finish();
    material.absorption = absorption;
}

// coat = { reflection = 0.04, grazing = 1, roughness = 0.1, specular = 0.5, shininess = 200 }, or
// false.
void read_coat(Section& section, Material& material) {
    if (section.is_false("coat")) {
        material.coat.reset();
        return;
    }
    auto inner = section.table("coat");
    if (!inner) return;
    Coat coat = material.coat.value_or(Coat{.reflection = 0.04F, .grazing = 1});
    inner->read("reflection", coat.reflection, fraction);
    inner->read("grazing", coat.grazing, fraction);
    inner->read("roughness", coat.roughness, fraction);
    read_mirrors(*inner, coat.mirrors);
    inner->read("specular", coat.specular, non_negative);
    inner->read("shininess", coat.shininess, non_negative);
    inner->finish();
    material.coat = coat;
}

// sheen = { color = [0.5, 0.4, 0.3], roughness = 0.3 }, or false.
void read_sheen(Section& section, Material& material) {
    if (section.is_false("sheen")) {
        material.sheen.reset();
        return;
    }
    auto inner = section.table("sheen");
    if (!inner) return;
    Sheen sheen = material.sheen.value_or(Sheen{.color = Color(1), .roughness = 0.3F});
    inner->read_factor("color", sheen.color);
    inner->read("roughness", sheen.roughness, fraction);
    inner->finish();
    material.sheen = sheen;
}

void read_material(Section& section, Material& material, Scene& scene, TextureFiles& files) {
    read_pigment(section, material, scene, files);
    section.read_factor("ambient", material.ambient);
    section.read("diffuse", material.diffuse, non_negative);
    section.read("specular", material.specular, non_negative);
    section.read("shininess", material.shininess, non_negative);
    section.read("metallic", material.metallic, fraction);
    Color highlight = material.specular_color.value_or(Color(1));
    if (section.read_color("specular_color", highlight)) material.specular_color = highlight;
    section.read_factor("reflection", material.reflection);
    section.read("roughness", material.roughness, fraction);
    read_mirrors(section, material.mirrors);
    section.read("conserve_energy", material.conserve_energy);
    section.read_color("emission", material.emission);
    section.read_factor("diffuse_transmission", material.diffuse_transmission);
    section.read("opacity", material.opacity, fraction);
    section.read("transmission", material.transmission, fraction);
    section.read("ior", material.ior, positive);
    section.read("fresnel", material.fresnel);
    read_absorption(section, material);
    read_coat(section, material);
    read_sheen(section, material);
    section.read("smooth", material.smooth);
    section.read("sides", material.sides, sides);
    section.finish();
}

std::vector<std::string> names_of(const std::vector<Material>& materials) {
    std::vector<std::string> names;
    for (const Material& material : materials)
        if (std::find(names.begin(), names.end(), material.name) == names.end())
            names.push_back(material.name);
    return names;
}

}  // namespace

Index load_texture(Section& section, const std::string& key, const std::string& file, Scene& scene,
                   TextureFiles& files) {
    const auto path = find_spelled((section.layer().folder / file).lexically_normal());
    if (const auto known = files.find(path); known != files.end()) return known->second;
    if (std::error_code ignored; !std::filesystem::exists(path, ignored))
        section.reject(key, fmt::format("is '{}': no such file", printable(path.string())));
    Texture texture = {.name = path.stem().string()};
    texture.raster = decode_image(read_bytes(path), path.string());
    scene.textures.push_back(std::move(texture));
    const auto index = Index(scene.textures.size() - 1);
    files.emplace(path, index);
    return index;
}

void lay_materials(const Layer& layer, Scene& scene, TextureFiles& files, NewMaterials& made) {
    for (auto& [name, section] : Section(layer, layer.table).named("material")) {
        bool found = false;
        for (Material& material : scene.materials) {
            if (material.name != name) continue;
            read_material(section, material, scene, files);
            found = true;
        }
        if (found) continue;
        Material fresh = {.name = name};
        if (section.has("texture")) fresh.color = Color(1);  // the image as it is
        read_material(section, fresh, scene, files);
        scene.materials.push_back(std::move(fresh));
        if (layer.setting)
            made[Index(scene.materials.size() - 1)] = {Failure::usage, layer.name, name};
    }
}

Index material_named(const Scene& scene, const Reference& reference) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (scene.materials[i].name == reference.name) return Index(i);
    throw Error(reference.failure, reference.place,
                fmt::format("no material '{}'{}", printable(reference.name),
                            hint(reference.name, names_of(scene.materials), "materials")));
}

}  // namespace penumbra
