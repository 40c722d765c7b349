// KHR_draco_mesh_compression -> plain accessors.
#include "base/memory.h"
#include "base/module.h"
#include "importers/gltf/document/compression.h"
#include "importers/gltf/document/document.h"
#include "importers/gltf/draco_module/draco_module.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <stdexcept>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

const std::string extension_name = "KHR_draco_mesh_compression";

// One primitive that is decompressed.
struct Inflater {
    Document& document;
    json& root;
    Losses& losses;
    std::string pointer;  // "/meshes/0/primitives/1"
    json& primitive;
    json extension = primitive["extensions"][extension_name];
    std::vector<std::string> names = {};  // of the attributes that are decompressed
    DracoMesh mesh = {};

    [[noreturn]] void fail(const std::string& problem) const {
        throw Error(Failure::input, document.place(pointer + "/extensions/" + extension_name),
                    problem);
    }
    json& accessor_of(const std::string& name) {
        return root["accessors"][primitive["attributes"][name].get<std::size_t>()];
    }
    void run();
    Bytes data() const;
    std::vector<DracoWish> wishes();
    int add_accessor(json accessor, std::vector<std::byte> bytes);
    void check_count(const json& accessor, std::size_t count, const std::string& what);
    void use_indices();
};

const DracoModule& draco_module() {
    static const DracoModule& module = *static_cast<const DracoModule*>(
        load_module({"Draco", "penumbra-draco.so", draco_module_entry, draco_module_abi}));
    return module;
}

Bytes Inflater::data() const {
    const json& view = root["bufferViews"][extension["bufferView"].get<std::size_t>()];
    const Bytes buffer = document.buffers[view["buffer"].get<std::size_t>()];
    if (buffer.empty()) fail(fmt::format("buffer {} has no content", view["buffer"].dump()));
    return buffer.subspan(view.value("byteOffset", std::size_t(0)),
                          view["byteLength"].get<std::size_t>());
}

DracoNumber number_of(std::uint64_t component_type) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return DracoNumber::i8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return DracoNumber::u8;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return DracoNumber::i16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return DracoNumber::u16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return DracoNumber::u32;
    default: return DracoNumber::f32;
    }
}

std::vector<DracoWish> Inflater::wishes() {
    std::vector<DracoWish> all;
    for (const auto& [name, id] : extension["attributes"].items()) {
        if (!primitive["attributes"].contains(name)) continue;
        const json& accessor = accessor_of(name);
        const std::string type = accessor["type"].get<std::string>();
        if (type[0] == 'M') fail(fmt::format("its {} is a {}", printable(name), type));
        names.push_back(name);
        all.push_back({.id = id.get<std::uint32_t>(),
                       .number = number_of(accessor["componentType"].get<std::uint64_t>()),
                       .width = type == "SCALAR" ? 1 : type.back() - '0'});
    }
    return all;
}

// What the accessor says must be what is in the data; where it is not, the data count.
void Inflater::check_count(const json& accessor, std::size_t count, const std::string& what) {
    const auto said = accessor["count"].get<std::size_t>();
    if (said == count) return;
    losses.push_back({Loss::approximated, document.place(pointer),
                      fmt::format("its compressed data have {} {}, its accessor says {}; the data "
                                  "are used",
                                  count, what, said)});
}

int Inflater::add_accessor(json accessor, std::vector<std::byte> bytes) {
    document.storage.push_back(std::move(bytes));
    document.buffers.emplace_back(document.storage.back());
    const std::size_t size = document.buffers.back().size();
    root["buffers"].push_back({{"byteLength", size}});
    root["bufferViews"].push_back({{"buffer", document.buffers.size() - 1}, {"byteLength", size}});
    accessor["bufferView"] = root["bufferViews"].size() - 1;
    root["accessors"].push_back(std::move(accessor));
    return int(root["accessors"].size()) - 1;
}

// A strip is decompressed to triangles as well.
void Inflater::use_indices() {
    if (primitive.contains("indices") && primitive.value("mode", 4) == TINYGLTF_MODE_TRIANGLES)
        check_count(root["accessors"][primitive["indices"].get<std::size_t>()], mesh.facets * 3,
                    "indices");
    primitive["mode"] = TINYGLTF_MODE_TRIANGLES;
    primitive["indices"] = add_accessor({{"type", "SCALAR"},
                                         {"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT},
                                         {"count", mesh.facets * 3}},
                                        std::move(mesh.indices));
}

// What libdraco takes for a facet and its corners, and what we copy of them; no facet has more than
// one vertex of its own, or hardly.
std::size_t memory_of_facet(const std::vector<DracoWish>& wishes) {
    constexpr std::size_t connectivity = 96, indices = 24, copies = 3;
    std::size_t bytes = connectivity + indices;
    for (const DracoWish& wish : wishes) bytes += copies * 4 * std::size_t(wish.width);
    return bytes;
}

void Inflater::run() {
    const int mode = primitive.value("mode", int(TINYGLTF_MODE_TRIANGLES));
    if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP)
        fail(fmt::format("is for triangles and strips of them, not for mode {}", mode));
    const Bytes compressed = data();
    const std::vector<DracoWish> wanted = wishes();
    MemoryClaim claim;
    try {
        const auto facets = std::size_t(draco_module().facets(compressed));
        claim = MemoryClaim(times(facets, memory_of_facet(wanted)),
                            document.place(pointer + "/extensions/" + extension_name));
        mesh = draco_module().decode(compressed, wanted);
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& error) {
        fail(std::string("cannot be decompressed: ") + error.what());
    }
    if (!mesh.problem.empty()) fail("cannot be decompressed: " + printable(mesh.problem));
    if (mesh.facets == 0) fail("has no facets");
    use_indices();
    for (std::size_t i = 0; i < names.size(); ++i) {
        const json old = accessor_of(names[i]);
        check_count(old, mesh.vertices, "vertices");
        primitive["attributes"][names[i]] =
            add_accessor({{"componentType", old["componentType"]},
                          {"type", old["type"]},
                          {"count", mesh.vertices},
                          {"normalized", old.value("normalized", false)}},
                         std::move(mesh.attributes[i]));
    }
    primitive["extensions"].erase(extension_name);
}

}  // namespace

void decode_draco(Document& document, json& root, Losses& losses) {
    if (!root.contains("meshes")) return;
    for (std::size_t m = 0; m < root["meshes"].size(); ++m) {
        json& primitives = root["meshes"][m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p)
            if (primitives[p].contains("extensions") &&
                primitives[p]["extensions"].contains(extension_name))
                Inflater{document, root, losses, fmt::format("/meshes/{}/primitives/{}", m, p),
                         primitives[p]}
                    .run();
    }
}

}  // namespace penumbra::gltf
