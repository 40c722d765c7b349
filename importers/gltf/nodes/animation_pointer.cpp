// KHR_animation_pointer -> the JSON as it is at one instant. Everything that is read from there
// later follows by itself: materials, lights, cameras and nodes.
#include "importers/gltf/nodes/animation_pointer.h"

#include "base/loss_tally.h"
#include "base/text/ascii.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/document/schema.h"
#include "importers/gltf/nodes/pose.h"
#include "importers/gltf/nodes/sampling.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string_view>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

// What a property is in the glTF 2.0 Asset Object Model.
enum class Property { flag, number, vec2, vec3, vec4, rotation, weights };

struct Animatable {
    std::string_view path;  // "*": an index
    Property property;
};

constexpr std::array animatable = {
    Animatable{"/nodes/*/translation", Property::vec3},
    Animatable{"/nodes/*/rotation", Property::rotation},
    Animatable{"/nodes/*/scale", Property::vec3},
    Animatable{"/nodes/*/weights", Property::weights},
    Animatable{"/nodes/*/weights/*", Property::number},
    Animatable{"/nodes/*/extensions/KHR_node_visibility/visible", Property::flag},
    Animatable{"/meshes/*/weights", Property::weights},
    Animatable{"/meshes/*/weights/*", Property::number},

    Animatable{"/cameras/*/perspective/aspectRatio", Property::number},
    Animatable{"/cameras/*/perspective/yfov", Property::number},
    Animatable{"/cameras/*/perspective/znear", Property::number},
    Animatable{"/cameras/*/perspective/zfar", Property::number},
    Animatable{"/cameras/*/orthographic/xmag", Property::number},
    Animatable{"/cameras/*/orthographic/ymag", Property::number},
    Animatable{"/cameras/*/orthographic/znear", Property::number},
    Animatable{"/cameras/*/orthographic/zfar", Property::number},

    Animatable{"/extensions/KHR_lights_punctual/lights/*/color", Property::vec3},
    Animatable{"/extensions/KHR_lights_punctual/lights/*/intensity", Property::number},
    Animatable{"/extensions/KHR_lights_punctual/lights/*/range", Property::number},
    Animatable{"/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", Property::number},
    Animatable{"/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", Property::number},

    Animatable{"/materials/*/pbrMetallicRoughness/baseColorFactor", Property::vec4},
    Animatable{"/materials/*/pbrMetallicRoughness/metallicFactor", Property::number},
    Animatable{"/materials/*/pbrMetallicRoughness/roughnessFactor", Property::number},
    Animatable{"/materials/*/alphaCutoff", Property::number},
    Animatable{"/materials/*/emissiveFactor", Property::vec3},
    Animatable{"/materials/*/normalTexture/scale", Property::number},
    Animatable{"/materials/*/occlusionTexture/strength", Property::number},
};

// Below /materials/*/extensions.
constexpr std::array animatable_extensions = {
    Animatable{"/KHR_materials_anisotropy/anisotropyRotation", Property::number},
    Animatable{"/KHR_materials_anisotropy/anisotropyStrength", Property::number},
    Animatable{"/KHR_materials_clearcoat/clearcoatFactor", Property::number},
    Animatable{"/KHR_materials_clearcoat/clearcoatNormalTexture/scale", Property::number},
    Animatable{"/KHR_materials_clearcoat/clearcoatRoughnessFactor", Property::number},
    Animatable{"/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
               Property::vec3},
    Animatable{"/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", Property::number},
    Animatable{"/KHR_materials_dispersion/dispersion", Property::number},
    Animatable{"/KHR_materials_emissive_strength/emissiveStrength", Property::number},
    Animatable{"/KHR_materials_ior/ior", Property::number},
    Animatable{"/KHR_materials_iridescence/iridescenceFactor", Property::number},
    Animatable{"/KHR_materials_iridescence/iridescenceIor", Property::number},
    Animatable{"/KHR_materials_iridescence/iridescenceThicknessMaximum", Property::number},
    Animatable{"/KHR_materials_iridescence/iridescenceThicknessMinimum", Property::number},
    Animatable{"/KHR_materials_pbrSpecularGlossiness/diffuseFactor", Property::vec4},
    Animatable{"/KHR_materials_pbrSpecularGlossiness/glossinessFactor", Property::number},
    Animatable{"/KHR_materials_pbrSpecularGlossiness/specularFactor", Property::vec3},
    Animatable{"/KHR_materials_sheen/sheenColorFactor", Property::vec3},
    Animatable{"/KHR_materials_sheen/sheenRoughnessFactor", Property::number},
    Animatable{"/KHR_materials_specular/specularColorFactor", Property::vec3},
    Animatable{"/KHR_materials_specular/specularFactor", Property::number},
    Animatable{"/KHR_materials_transmission/transmissionFactor", Property::number},
    Animatable{"/KHR_materials_volume/attenuationColor", Property::vec3},
    Animatable{"/KHR_materials_volume/attenuationDistance", Property::number},
    Animatable{"/KHR_materials_volume/thicknessFactor", Property::number},
};

// Below every reference to a texture.
constexpr std::array animatable_transforms = {
    Animatable{"/extensions/KHR_texture_transform/offset", Property::vec2},
    Animatable{"/extensions/KHR_texture_transform/rotation", Property::number},
    Animatable{"/extensions/KHR_texture_transform/scale", Property::vec2},
};

// A number of at most nine digits, as JSON pointers write it.
bool is_index(std::string_view word) {
    return !word.empty() && word.size() < 10 && (word.size() == 1 || word.front() != '0') &&
           std::ranges::all_of(word, is_digit);
}

// The next name of a path, which begins with a slash; what is left of it.
std::string_view take_name(std::string_view& path) {
    path.remove_prefix(1);
    const std::string_view name = path.substr(0, path.find('/'));
    path.remove_prefix(name.size());
    return name;
}

bool matches(std::string_view pointer, std::string_view path) {
    while (!pointer.empty() && !path.empty() && pointer.front() == '/') {
        const std::string_view name = take_name(pointer), wanted = take_name(path);
        if (wanted == "*" ? !is_index(name) : name != wanted) return false;
    }
    return pointer.empty() && path.empty();
}

std::optional<Property> property_of(std::string_view pointer) {
    for (const Animatable& each : animatable)
        if (matches(pointer, each.path)) return each.property;
    for (const Animatable& each : animatable_extensions)
        if (matches(pointer, "/materials/*/extensions" + std::string(each.path)))
            return each.property;
    for (const std::string_view texture : texture_references)
        for (const Animatable& each : animatable_transforms)
            if (matches(pointer, std::string(texture).append(each.path))) return each.property;
    return std::nullopt;
}

ValueKind kind_of(Property property) {
    switch (property) {
    case Property::flag: return {.type = TINYGLTF_TYPE_SCALAR, .stepped = true};
    case Property::vec2: return {.type = TINYGLTF_TYPE_VEC2};
    case Property::vec3: return {.type = TINYGLTF_TYPE_VEC3};
    case Property::vec4: return {.type = TINYGLTF_TYPE_VEC4};
    case Property::rotation: return {.type = TINYGLTF_TYPE_VEC4, .rotation = true};
    case Property::weights: return {.type = TINYGLTF_TYPE_SCALAR, .elements = 0};
    default: return {.type = TINYGLTF_TYPE_SCALAR};
    }
}

json json_of(const std::vector<double>& value, Property property) {
    if (property == Property::flag) return value.front() != 0;
    if (property == Property::number) return value.front();
    return value;
}

// A node's weights are its mesh's until it has its own, and a mesh's are 0.
void write_weights(json& root, json& owner) {
    if (owner.contains("weights")) return;
    if (owner.contains("mesh")) {
        json& mesh = root["meshes"][owner["mesh"].get<std::size_t>()];
        write_weights(root, mesh);
        if (mesh.contains("weights")) owner["weights"] = mesh["weights"];
    } else if (owner.contains("primitives") && !owner["primitives"].empty() &&
               owner["primitives"][0].contains("targets")) {
        owner["weights"] = json::array_t(owner["primitives"][0]["targets"].size(), 0);
    }
}

// What the pointer's property belongs to; nullptr if the file has no such thing. Objects that may
// be absent because all of their members have defaults are made.
json* owner_of(json& root, const json::json_pointer& pointer) {
    const json::json_pointer above = pointer.parent_pointer();
    if (root.contains(above)) return &root[above];
    const json::json_pointer higher = above.parent_pointer();
    const std::string& name = above.back();
    const bool optional = name == "pbrMetallicRoughness" || name == "spot" || name == "weights";
    if (!optional || !root.contains(higher) || !root[higher].is_object()) return nullptr;
    if (name == "weights")
        write_weights(root, root[higher]);
    else
        root[higher][name] = json::object();
    return root.contains(above) ? &root[above] : nullptr;
}

// Whether the pointer leads to a property that is there, or could be.
bool has_place(const json& owner, const std::string& name) {
    return owner.is_array() ? std::stoul(name) < owner.size() : owner.is_object();
}

bool is_transform_of_matrix(const json& owner, std::string_view pointer) {
    return pointer.starts_with("/nodes/") && owner.contains("matrix") &&
           (pointer.ends_with("/translation") || pointer.ends_with("/rotation") ||
            pointer.ends_with("/scale"));
}

// The channels of one animation.
struct Follower {
    const Document& document;
    json& root;
    std::size_t animation;
    double time;
    LossTally& losses;
    TimesByAccessor known = {};

    bool follow(const json& channel, const std::string& place);
    bool set(const std::string& text, std::size_t sampler, const std::string& place);
};

bool Follower::set(const std::string& text, std::size_t sampler, const std::string& place) {
    const auto ignore = [&](const char* why) {
        losses.add_alone(
            {Loss::dropped, place,
             fmt::format("its animation of '{}' is ignored: {}", printable(text), why)});
        return false;
    };
    const auto property = property_of(text);
    if (!property) return ignore("it is no property that can be animated here");
    const json::json_pointer pointer(text);
    json* const owner = owner_of(root, pointer);
    if (owner == nullptr || !has_place(*owner, pointer.back()))
        return ignore("the file has no such thing");
    if (is_transform_of_matrix(*owner, text)) return ignore("the node has a matrix");
    const auto& source = document.model.animations[animation].samplers[sampler];
    const auto value =
        value_at({document, source, fmt::format("/animations/{}/samplers/{}", animation, sampler)},
                 time, kind_of(*property), known);
    root[pointer] = json_of(value, *property);
    return true;
}

bool Follower::follow(const json& channel, const std::string& place) {
    const json& target = channel["target"];
    if (target["path"] != "pointer") return false;
    const json::json_pointer member("/extensions/KHR_animation_pointer/pointer");
    if (!target.contains(member) || !target[member].is_string()) {
        losses.add_alone({Loss::dropped, place, "it has no pointer and is ignored"});
        return false;
    }
    return set(target[member].get<std::string>(), channel["sampler"].get<std::size_t>(), place);
}

}  // namespace

bool follow_pointers(const Document& document, const ModelOptions& options, json& root,
                     Losses& losses) {
    const auto chosen = chosen_animation(document, options);
    if (!chosen) return false;
    LossTally found;
    Follower follower = {document, root, *chosen, options.time.value_or(0), found};
    const json channels = root["animations"][*chosen]["channels"];
    bool changed = false;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const std::string pointer = fmt::format("/animations/{}/channels/{}", *chosen, i);
        changed |= follower.follow(channels[i], document.place(pointer));
    }
    std::ranges::copy(found.losses(), std::back_inserter(losses));
    return changed;
}

}  // namespace penumbra::gltf
