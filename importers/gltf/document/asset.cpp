// JSON -> is this a glTF 2 file, and one that the importer can show?
#include "base/text/ascii.h"
#include "base/text/suggest.h"
#include "importers/gltf/document/checks.h"
#include "importers/gltf/document/document.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <string_view>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

// What the importer carries over, or may leave aside because the file has a plain version as well.
const std::set<std::string> supported = {
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_lights_image_based",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "KHR_animation_pointer",
    "KHR_accessor_float16",
    "KHR_accessor_float64",
    "KHR_mesh_primitive_restart",
    "EXT_mesh_primitive_restart",
};

// What changes no still picture: behaviour, sound, and what is known about the shapes.
const std::set<std::string> unseen = {
    "KHR_interactivity",
    "KHR_node_selectability",
    "KHR_node_hoverability",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_physics_rigid_bodies",
    "KHR_implicit_shapes",
    "KHR_audio_emitter",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "EXT_mesh_manifold",
    "MSFT_lod",
    "MSFT_audio_emitter",
    "MSFT_collision_mesh",
    "MSFT_physics_rigid_bodies",
    "OMI_collider",
    "OMI_physics_body",
    "OMI_physics_shape",
    "AGI_stk_metadata",
    "FB_geometry_metadata",
    "FB_ngon_encoding",
};

// What a material or texture that uses them says itself.
const std::set<std::string> named_later = {
    "KHR_materials_sheen",      "KHR_materials_anisotropy", "KHR_materials_iridescence",
    "KHR_materials_dispersion", "KHR_texture_basisu",       "KHR_gaussian_splatting",
};

bool is_known(const std::string& extension) {
    return supported.contains(extension) || named_later.contains(extension) ||
           unseen.contains(extension);
}

// Required, but the shapes are right without: shown with the plain material, and a loss.
bool only_appearance(const std::string& extension) {
    return extension.starts_with("KHR_materials_");
}

// Two whole numbers, as their digits: they may be of any size.
struct Version {
    std::string major = {}, minor = {};
};

// glTF 2.0, section 3.2.
bool is_whole(std::string_view digits) {
    return !digits.empty() && std::ranges::all_of(digits, is_digit) &&
           (digits.size() == 1 || digits.front() != '0');
}

Version version(const json& value, const std::string& place) {
    const std::string given = printable(value.dump());
    if (!value.is_string())
        throw Error(Failure::input, place,
                    fmt::format("must be a string such as \"2.0\", but is {}", given));
    const auto& text = value.get_ref<const std::string&>();
    const std::size_t dot = std::min(text.find('.'), text.size());
    const Version found = {text.substr(0, dot), text.substr(std::min(dot + 1, text.size()))};
    if (!is_whole(found.major) || !is_whole(found.minor))
        throw Error(Failure::input, place,
                    fmt::format("is {}, but must be two whole numbers without leading zeros, such "
                                "as \"2.0\"",
                                given));
    return found;
}

void check_version(const json& asset, const std::string& file) {
    const std::string place = file + "#/asset/version", least = file + "#/asset/minVersion";
    if (version(asset["version"], place).major != "2")
        throw Error(
            Failure::input, place,
            fmt::format("is {}, only glTF 2 is supported", printable(asset["version"].dump())));
    if (!asset.contains("minVersion")) return;
    const auto [major, minor] = version(asset["minVersion"], least);
    const bool older = major == "0" || major == "1";
    if (!older && (major != "2" || minor != "0"))
        throw Error(
            Failure::input, least,
            fmt::format("is {}, only 2.0 is supported", printable(asset["minVersion"].dump())));
}

}  // namespace

void check_asset(const json& root, const std::string& file, Losses& losses) {
    if (!root.is_object()) throw Error(Failure::input, file, "the JSON is not an object");
    if (!root.contains("asset") || !root["asset"].is_object() || !root["asset"].contains("version"))
        throw Error(Failure::input, file, "there is no asset.version: is this a glTF 2.0 file?");

    check_version(root["asset"], file);
    const auto names = [&](const char* key) {
        std::vector<std::string> found;
        if (!root.contains(key)) return found;
        if (!root[key].is_array())
            throw Error(Failure::input, file + "#/" + key, "must be an array");
        for (const json& name : root[key])
            if (name.is_string()) found.push_back(name.get<std::string>());
        return found;
    };
    for (const std::string& name : names("extensionsRequired"))
        if (!is_known(name) && !only_appearance(name))
            throw Error(Failure::input, file + "#/extensionsRequired",
                        fmt::format("the model needs the extension {}, which is not supported",
                                    printable(name)));
    for (const std::string& name : names("extensionsUsed"))
        if (!is_known(name))
            losses.push_back({Loss::dropped, file + "#/extensionsUsed",
                              fmt::format("the extension {} is ignored", printable(name))});
}

}  // namespace penumbra::gltf
