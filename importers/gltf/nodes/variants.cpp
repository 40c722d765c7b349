// KHR_materials_variants: which material a primitive has.
#include "importers/gltf/nodes/mesh.h"

#include <fmt/format.h>

namespace penumbra::gltf {
namespace {

constexpr const char* extension = "KHR_materials_variants";

// The elements of an extension's array.
std::vector<tinygltf::Value> elements(const tinygltf::ExtensionMap& extensions,
                                      const std::string& key) {
    std::vector<tinygltf::Value> result;
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.Has(key)) return result;
    const tinygltf::Value& array = found->second.Get(key);
    for (std::size_t i = 0; i < array.ArrayLen(); ++i) result.push_back(array.Get(int(i)));
    return result;
}

std::string name_of(const tinygltf::Value& variant) {
    return variant.Has("name") && variant.Get("name").IsString()
               ? variant.Get("name").Get<std::string>()
               : std::string();
}

// The number of the chosen variant. Throws Error (usage) where there is none of that name.
int chosen_variant(const Reader& reader) {
    const auto variants = elements(reader.document.model.extensions, "variants");
    std::string names;
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const std::string name = name_of(variants[i]);
        if (name == reader.options.variant) return int(i);
        names += (names.empty() ? "" : ", ") + fmt::format("'{}'", printable(name));
    }
    throw Error(Failure::usage, reader.document.file,
                fmt::format("there is no variant '{}': {}", printable(reader.options.variant),
                            names.empty() ? "the file has none" : "it has " + names));
}

}  // namespace

int material_of(const Reader& reader, const tinygltf::Primitive& primitive) {
    if (reader.options.variant.empty()) return primitive.material;
    const int chosen = chosen_variant(reader);
    for (const tinygltf::Value& mapping : elements(primitive.extensions, "mappings")) {
        if (!mapping.Has("variants") || !mapping.Has("material")) continue;
        const tinygltf::Value& variants = mapping.Get("variants");
        for (std::size_t i = 0; i < variants.ArrayLen(); ++i)
            if (variants.Get(int(i)).GetNumberAsInt() == chosen)
                return mapping.Get("material").GetNumberAsInt();
    }
    return primitive.material;
}

}  // namespace penumbra::gltf
