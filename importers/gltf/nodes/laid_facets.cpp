// The facets that wear a material, as its images see them.
#include "base/memory.h"
#include "importers/gltf/nodes/mesh.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::gltf {
namespace {

bool morphs(const Part& part, const std::string& name) {
    for (const auto& target : part.primitive.targets)
        if (target.contains(name)) return true;
    return false;
}

// False where that cannot be told.
bool add_facets(const Part& part, int texcoord, std::vector<LaidFacet>& facets) {
    const std::string name = fmt::format("TEXCOORD_{}", texcoord);
    if (attribute(part, "POSITION", {TINYGLTF_TYPE_VEC3}) < 0) return true;
    if (attribute(part, name, {TINYGLTF_TYPE_VEC2}) < 0) return true;  // nor has it the image
    if (morphs(part, name)) return false;
    const auto triangles = read_facets(part);
    if (triangles.empty()) return true;
    const std::size_t count = part.accessor(part.primitive.attributes.at("POSITION")).count;
    const auto texcoords = read_texcoord_set(part, name, {.first = 0, .count = count});
    for (const auto& [a, b, c] : triangles) {
        if (std::max({a, b, c}) >= count) return false;
        facets.push_back({texcoords[a], texcoords[b], texcoords[c]});
    }
    return true;
}

// Of all meshes, whether or not they are shown.
std::optional<std::vector<LaidFacet>> facets_of(const Reader& reader, const Alone& worn,
                                                int texcoord) {
    // What is to be said of the meshes is said where they are read.
    Scene scene;
    LossTally losses;
    Reader quiet{reader.document, scene, losses, reader.options};
    const tinygltf::Model& model = reader.document.model;
    std::vector<LaidFacet> facets;
    for (std::size_t m = 0; m < model.meshes.size(); ++m) {
        const MeshKey key = {.mesh = int(m)};
        for (const tinygltf::Primitive& primitive : model.meshes[m].primitives) {
            if (worn.primitive != nullptr ? &primitive != worn.primitive
                                          : material_of(reader, primitive) != worn.material)
                continue;
            if (!add_facets({quiet, primitive, key, {}}, texcoord, facets)) return std::nullopt;
        }
    }
    return facets;
}

}  // namespace

void offer_facets(Reader& reader) {
    reader.cache.wearers = [&reader](int material) {
        std::vector<const tinygltf::Primitive*> found;
        for (const tinygltf::Mesh& mesh : reader.document.model.meshes)
            for (const tinygltf::Primitive& primitive : mesh.primitives)
                if (material_of(reader, primitive) == material) found.push_back(&primitive);
        return found;
    };
    reader.cache.facets = [&reader](const Alone& worn,
                                    int texcoord) -> std::optional<std::vector<LaidFacet>> {
        try {
            return facets_of(reader, worn, texcoord);
        } catch (const MemoryError&) {
            throw;
        } catch (const Error&) {  // in a mesh that may not be shown
            return std::nullopt;
        }
    };
}

}  // namespace penumbra::gltf
