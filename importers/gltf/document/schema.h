// The glTF 2.0 schema as a table, as far as the importer relies on it.
//
// A path names members from the root: "*" stands for every element of an array, "@" for every
// member of an object; what a path passes through must be an array or an object. A name with "!"
// at its end must be present wherever its parent is.
#pragma once

#include <array>
#include <limits>
#include <string_view>

namespace penumbra::gltf {

enum class Kind {
    reference,  ///< index into the array at `to`
    whole,      ///< integer in [low, high]
    number,     ///< in [low, high]
    factor,     ///< number, or `length` numbers, brought into [low, high] if outside
    numbers,    ///< `length` numbers; 0: any
    text,
    flag,
    choice,  ///< one of the words in `to`, separated by blanks
    object,
};

struct Rule {
    std::string_view path;
    Kind kind;
    std::string_view to = {};
    int length = 0;
    double low = -std::numeric_limits<float>::max(), high = std::numeric_limits<float>::max();
};

inline constexpr double largest_size = 9007199254740992;  // 2^53: exact in any JSON reader
inline constexpr double largest_int = 2147483647;         // what tinygltf keeps of some sizes
inline constexpr double largest_float = std::numeric_limits<float>::max();

constexpr Rule reference(std::string_view path, std::string_view to) {
    return {path, Kind::reference, to};
}
constexpr Rule whole(std::string_view path, double low = 0, double high = largest_size) {
    return {.path = path, .kind = Kind::whole, .low = low, .high = high};
}
constexpr Rule number(std::string_view path, double low, double high = largest_float) {
    return {.path = path, .kind = Kind::number, .low = low, .high = high};
}
constexpr Rule factor(std::string_view path, int length, double high = 1) {
    return {.path = path, .kind = Kind::factor, .length = length, .low = 0, .high = high};
}
constexpr Rule numbers(std::string_view path, int length = 0) {
    return {.path = path, .kind = Kind::numbers, .length = length};
}
constexpr Rule text(std::string_view path) { return {path, Kind::text}; }
constexpr Rule flag(std::string_view path) { return {path, Kind::flag}; }
constexpr Rule object(std::string_view path) { return {path, Kind::object}; }
constexpr Rule choice(std::string_view path, std::string_view words) {
    return {path, Kind::choice, words};
}

inline constexpr std::array schema = {
    // First, so that "must be an array" comes before "the file has 0 meshes".
    object("/scenes/*"),
    object("/nodes/*"),
    object("/meshes/*"),
    object("/accessors/*"),
    object("/bufferViews/*"),
    object("/buffers/*"),
    object("/images/*"),
    object("/textures/*"),
    object("/samplers/*"),
    object("/materials/*"),
    object("/cameras/*"),
    object("/skins/*"),
    object("/animations/*"),

    object("/files/*"),
    object("/externalAssets/*"),

    text("/extensionsUsed/*"),
    reference("/scene", "/scenes"),
    text("/scenes/*/name"),
    reference("/scenes/*/nodes/*", "/nodes"),

    text("/nodes/*/name"),
    reference("/nodes/*/children/*", "/nodes"),
    reference("/nodes/*/mesh", "/meshes"),
    reference("/nodes/*/camera", "/cameras"),
    reference("/nodes/*/skin", "/skins"),
    reference("/nodes/*/externalAsset", "/externalAssets"),
    numbers("/nodes/*/matrix", 16),
    numbers("/nodes/*/translation", 3),
    numbers("/nodes/*/rotation", 4),
    numbers("/nodes/*/scale", 3),
    numbers("/nodes/*/weights"),
    reference("/scenes/*/extensions/EXT_lights_image_based/light!",
              "/extensions/EXT_lights_image_based/lights"),
    reference("/nodes/*/extensions/KHR_lights_punctual/light!",
              "/extensions/KHR_lights_punctual/lights"),
    flag("/nodes/*/extensions/KHR_node_visibility/visible"),
    reference("/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes!/@", "/accessors"),

    text("/meshes/*/name"),
    object("/meshes/*/primitives!/*"),
    reference("/meshes/*/primitives/*/attributes!/@", "/accessors"),
    reference("/meshes/*/primitives/*/indices", "/accessors"),
    reference("/meshes/*/primitives/*/material", "/materials"),
    whole("/meshes/*/primitives/*/mode", 0, 6),
    reference("/meshes/*/primitives/*/targets/*/@", "/accessors"),
    object("/meshes/*/primitives/*/extensions"),
    reference("/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView!",
              "/bufferViews"),
    whole("/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes!/@", 0,
          largest_int),
    numbers("/meshes/*/weights"),

    reference("/accessors/*/bufferView", "/bufferViews"),
    whole("/accessors/*/byteOffset"),
    whole("/accessors/*/componentType!"),
    whole("/accessors/*/count!", 1),
    flag("/accessors/*/normalized"),
    choice("/accessors/*/type!", "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"),
    whole("/accessors/*/sparse/count!", 1, largest_int),
    reference("/accessors/*/sparse/indices!/bufferView!", "/bufferViews"),
    whole("/accessors/*/sparse/indices/byteOffset", 0, largest_int),
    whole("/accessors/*/sparse/indices/componentType!"),
    reference("/accessors/*/sparse/values!/bufferView!", "/bufferViews"),
    whole("/accessors/*/sparse/values/byteOffset", 0, largest_int),

    reference("/bufferViews/*/buffer!", "/buffers"),
    whole("/bufferViews/*/byteOffset"),
    whole("/bufferViews/*/byteLength!"),
    whole("/bufferViews/*/byteStride", 1, 252),
    reference("/bufferViews/*/extensions/EXT_meshopt_compression/buffer!", "/buffers"),
    whole("/bufferViews/*/extensions/EXT_meshopt_compression/byteOffset"),
    whole("/bufferViews/*/extensions/EXT_meshopt_compression/byteLength!"),
    whole("/bufferViews/*/extensions/EXT_meshopt_compression/byteStride!", 1, 256),
    whole("/bufferViews/*/extensions/EXT_meshopt_compression/count!", 1),
    choice("/bufferViews/*/extensions/EXT_meshopt_compression/mode!",
           "ATTRIBUTES TRIANGLES INDICES"),
    choice("/bufferViews/*/extensions/EXT_meshopt_compression/filter",
           "NONE OCTAHEDRAL QUATERNION EXPONENTIAL"),
    reference("/bufferViews/*/extensions/KHR_meshopt_compression/buffer!", "/buffers"),
    whole("/bufferViews/*/extensions/KHR_meshopt_compression/byteOffset"),
    whole("/bufferViews/*/extensions/KHR_meshopt_compression/byteLength!"),
    whole("/bufferViews/*/extensions/KHR_meshopt_compression/byteStride!", 1, 256),
    whole("/bufferViews/*/extensions/KHR_meshopt_compression/count!", 1),
    choice("/bufferViews/*/extensions/KHR_meshopt_compression/mode!",
           "ATTRIBUTES TRIANGLES INDICES"),
    choice("/bufferViews/*/extensions/KHR_meshopt_compression/filter",
           "NONE OCTAHEDRAL QUATERNION EXPONENTIAL COLOR"),

    whole("/buffers/*/byteLength!"),
    text("/buffers/*/uri"),
    flag("/buffers/*/extensions/EXT_meshopt_compression/fallback"),
    flag("/buffers/*/extensions/KHR_meshopt_compression/fallback"),

    text("/images/*/name"),
    text("/images/*/uri"),
    reference("/images/*/bufferView", "/bufferViews"),

    text("/textures/*/name"),
    text("/files/*/name"),
    text("/files/*/uri"),
    reference("/files/*/bufferView", "/bufferViews"),
    reference("/externalAssets/*/file!", "/files"),

    reference("/textures/*/source", "/images"),
    reference("/textures/*/sampler", "/samplers"),
    reference("/textures/*/extensions/EXT_texture_webp/source", "/images"),
    reference("/textures/*/extensions/EXT_texture_avif/source", "/images"),
    reference("/textures/*/extensions/KHR_texture_basisu/source", "/images"),

    whole("/samplers/*/magFilter", 0, largest_int),
    whole("/samplers/*/minFilter", 0, largest_int),
    whole("/samplers/*/wrapS", 0, largest_int),
    whole("/samplers/*/wrapT", 0, largest_int),

    text("/materials/*/name"),
    factor("/materials/*/pbrMetallicRoughness/baseColorFactor", 4),
    factor("/materials/*/pbrMetallicRoughness/metallicFactor", 0),
    factor("/materials/*/pbrMetallicRoughness/roughnessFactor", 0),
    factor("/materials/*/emissiveFactor", 3, largest_float),
    choice("/materials/*/alphaMode", "OPAQUE MASK BLEND"),
    number("/materials/*/alphaCutoff", 0),
    flag("/materials/*/doubleSided"),
    number("/materials/*/normalTexture/scale", -largest_float),
    object("/materials/*/extensions/@"),
    number("/materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 0),
    number("/materials/*/extensions/KHR_materials_ior/ior", 0),
    factor("/materials/*/extensions/KHR_materials_specular/specularFactor", 0),
    factor("/materials/*/extensions/KHR_materials_specular/specularColorFactor", 3, largest_float),
    factor("/materials/*/extensions/KHR_materials_transmission/transmissionFactor", 0),
    number("/materials/*/extensions/KHR_materials_volume/thicknessFactor", 0),
    number("/materials/*/extensions/KHR_materials_volume/attenuationDistance", 0),
    factor("/materials/*/extensions/KHR_materials_volume/attenuationColor", 3),
    factor("/materials/*/extensions/KHR_materials_clearcoat/clearcoatFactor", 0),
    factor("/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 0),
    factor("/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4),
    factor("/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 3),
    factor("/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 0),
    text("/extensions/KHR_materials_variants/variants/*/name!"),
    reference("/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/material!",
              "/materials"),
    reference("/meshes/*/primitives/*/extensions/KHR_materials_variants/mappings/*/variants!/*",
              "/extensions/KHR_materials_variants/variants"),

    text("/cameras/*/name"),
    choice("/cameras/*/type!", "perspective orthographic"),
    number("/cameras/*/perspective/yfov!", 0.00001, 3.14159),
    number("/cameras/*/perspective/znear!", -largest_float),
    number("/cameras/*/orthographic/xmag!", -largest_float),
    number("/cameras/*/orthographic/ymag!", -largest_float),
    number("/cameras/*/orthographic/zfar!", -largest_float),
    number("/cameras/*/orthographic/znear!", -largest_float),

    reference("/skins/*/joints!/*", "/nodes"),
    reference("/skins/*/skeleton", "/nodes"),
    reference("/skins/*/inverseBindMatrices", "/accessors"),

    text("/animations/*/name"),
    reference("/animations/*/samplers!/*/input!", "/accessors"),
    reference("/animations/*/samplers/*/output!", "/accessors"),
    choice("/animations/*/samplers/*/interpolation", "LINEAR STEP CUBICSPLINE"),
    whole("/animations/*/channels!/*/sampler!", 0, largest_int),
    reference("/animations/*/channels/*/target!/node", "/nodes"),
    text("/animations/*/channels/*/target/path!"),

    object("/extensions/EXT_lights_image_based/lights/*"),
    text("/extensions/EXT_lights_image_based/lights/*/name"),
    numbers("/extensions/EXT_lights_image_based/lights/*/rotation", 4),
    number("/extensions/EXT_lights_image_based/lights/*/intensity", 0),
    reference("/extensions/EXT_lights_image_based/lights/*/specularImages!/*/*", "/images"),

    object("/extensions/KHR_lights_punctual/lights/*"),
    text("/extensions/KHR_lights_punctual/lights/*/name"),
    text("/extensions/KHR_lights_punctual/lights/*/type!"),
    numbers("/extensions/KHR_lights_punctual/lights/*/color", 3),
    number("/extensions/KHR_lights_punctual/lights/*/intensity", 0),
    number("/extensions/KHR_lights_punctual/lights/*/range", 0),
    number("/extensions/KHR_lights_punctual/lights/*/spot/innerConeAngle", 0, 1.5708),
    number("/extensions/KHR_lights_punctual/lights/*/spot/outerConeAngle", 0, 1.5708),
};

/// Where materials refer to textures. Each has the members of `texture_members`.
inline constexpr std::array<std::string_view, 16> texture_references = {
    "/materials/*/pbrMetallicRoughness/baseColorTexture",
    "/materials/*/pbrMetallicRoughness/metallicRoughnessTexture",
    "/materials/*/normalTexture",
    "/materials/*/occlusionTexture",
    "/materials/*/emissiveTexture",
    "/materials/*/extensions/KHR_materials_specular/specularTexture",
    "/materials/*/extensions/KHR_materials_specular/specularColorTexture",
    "/materials/*/extensions/KHR_materials_transmission/transmissionTexture",
    "/materials/*/extensions/KHR_materials_volume/thicknessTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture",
    "/materials/*/extensions/KHR_materials_clearcoat/clearcoatNormalTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture",
    "/materials/*/extensions/KHR_materials_sheen/sheenColorTexture",
    "/materials/*/extensions/KHR_materials_sheen/sheenRoughnessTexture",
};

inline constexpr std::array texture_members = {
    reference("/index!", "/textures"),
    whole("/texCoord", 0, largest_int),
    numbers("/extensions/KHR_texture_transform/offset", 2),
    number("/extensions/KHR_texture_transform/rotation", -largest_float),
    numbers("/extensions/KHR_texture_transform/scale", 2),
    whole("/extensions/KHR_texture_transform/texCoord", 0, largest_int),
};

}  // namespace penumbra::gltf
