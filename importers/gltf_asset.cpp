// JSON -> is this a glTF 2 file, and one that the importer can show?
#include "gltf.h"
#include "suggest.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <set>
#include <utility>

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
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
    "EXT_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
};

// What a material or texture that uses them says itself.
const std::set<std::string> named_later = {
    "KHR_materials_sheen",       "KHR_materials_anisotropy",
    "KHR_materials_iridescence", "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",  "KHR_texture_basisu",
};

// Required, but the shapes are right without: shown with the plain material or as the nodes' own
// properties say, and a loss.
bool only_appearance(const std::string& extension) {
    return extension.rfind("KHR_materials_", 0) == 0 || extension == "KHR_animation_pointer";
}

// "2.1" -> {2, 1}; {0, 0} when it is no version.
std::pair<int, int> version(const json& value) {
    int major = 0, minor = 0, end = 0;
    if (!value.is_string()) return {0, 0};
    const std::string text = value.get<std::string>();
    if (std::sscanf(text.c_str(), "%4d.%4d%n", &major, &minor, &end) != 2 ||
        std::size_t(end) != text.size())
        return {0, 0};
    return {major, minor};
}

}  // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t longest = 80;
    const std::string line = penumbra::printable(text.substr(0, longest));
    return text.size() > longest ? line + "..." : line;
}

void check_asset(const json& root, const std::string& file, Losses& losses) {
    if (!root.is_object()) throw Error(Failure::input, file, "the JSON is not an object");
    if (!root.contains("asset") || !root["asset"].is_object() || !root["asset"].contains("version"))
        throw Error(Failure::input, file, "there is no asset.version: is this a glTF 2.0 file?");

    const json& asset = root["asset"];
    const auto [major, minor] = version(asset["version"]);
    if (major != 2)
        throw Error(
            Failure::input, file + "#/asset/version",
            fmt::format("is {}, only glTF 2 is supported", printable(asset["version"].dump())));
    if (asset.contains("minVersion") && version(asset["minVersion"]) != std::pair(2, 0))
        throw Error(
            Failure::input, file + "#/asset/minVersion",
            fmt::format("is {}, only 2.0 is supported", printable(asset["minVersion"].dump())));

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
        if (!supported.count(name) && !named_later.count(name) && !only_appearance(name))
            throw Error(Failure::input, file + "#/extensionsRequired",
                        fmt::format("the model needs the extension {}, which is not supported",
                                    printable(name)));
    for (const std::string& name : names("extensionsUsed"))
        if (!supported.count(name) && !named_later.count(name))
            losses.push_back({file + "#/extensionsUsed",
                              fmt::format("the extension {} is ignored", printable(name))});
}

}  // namespace penumbra::gltf
