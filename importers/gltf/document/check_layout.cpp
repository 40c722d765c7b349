// Checked JSON -> JSON whose accessors lie within their buffers and whose nodes form trees.
#include "base/loss_tally.h"
#include "importers/gltf/document/checks.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <iterator>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

std::uint64_t size_at(const json& object, const char* key, std::uint64_t fallback = 0) {
    return object.value(key, fallback);
}

// KHR_accessor_float16 and KHR_accessor_float64 have these in glTF 2.0, and 2.1 without them.
constexpr std::uint64_t component_half = 5131;

std::uint64_t component_size(std::uint64_t type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return 4;
    case TINYGLTF_COMPONENT_TYPE_DOUBLE: return 8;
    case component_half: return 2;
    default: return 0;
    }
}

bool is_unsigned(std::uint64_t type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// glTF 2.0, section 3.6.2.4: each column of a matrix starts at a multiple of four bytes.
std::uint64_t element_size(const std::string& type, std::uint64_t component) {
    if (type == "SCALAR") return component;
    const std::uint64_t n = std::uint64_t(type.back() - '0');
    if (type[0] == 'V') return n * component;
    const std::uint64_t column = (n * component + 3) / 4 * 4;
    return column * (n - 1) + n * component;
}

struct Layout {
    const json& root;
    const std::string& file;
    Losses& losses;

    [[noreturn]] void fail(const std::string& pointer, const std::string& problem) const {
        throw Error(Failure::input, file + '#' + pointer, problem);
    }

    void views() const {
        for (std::size_t i = 0; root.contains("bufferViews") && i < root["bufferViews"].size();
             ++i) {
            const json& view = root["bufferViews"][i];
            const std::uint64_t end = size_at(view, "byteOffset") + size_at(view, "byteLength");
            const std::uint64_t buffer = size_at(view, "buffer");
            const std::uint64_t has = size_at(root["buffers"][buffer], "byteLength");
            if (end > has)
                fail(fmt::format("/bufferViews/{}", i),
                     fmt::format("ends at byte {} of buffer {}, which has {}", end, buffer, has));
        }
    }

    // `count` elements of `element` bytes from `offset` on; `what` begins the message.
    void fits(const std::string& pointer, const json& slice, std::uint64_t count,
              std::uint64_t element) const {
        const std::uint64_t index = size_at(slice, "bufferView");
        const json& view = root["bufferViews"][index];
        const std::uint64_t stride = size_at(view, "byteStride", element);
        if (stride < element)
            fail(pointer, fmt::format("has elements of {} bytes, more than the byteStride {} of "
                                      "buffer view {}",
                                      element, stride, index));
        const std::uint64_t end = size_at(slice, "byteOffset") + (count - 1) * stride + element;
        if (end > size_at(view, "byteLength"))
            fail(pointer, fmt::format("ends at byte {} of buffer view {}, which has {}", end, index,
                                      size_at(view, "byteLength")));
    }

    void accessors() const;
    void alignment() const;
    void uses() const;
    void trees() const;
    void transforms() const;
};

// An accessor without a buffer view is all zeros, which costs its author no bytes.
constexpr std::uint64_t max_implicit_count = std::uint64_t(1) << 24;

void Layout::accessors() const {
    for (std::size_t i = 0; root.contains("accessors") && i < root["accessors"].size(); ++i) {
        const json& accessor = root["accessors"][i];
        const std::string at = fmt::format("/accessors/{}", i);
        const std::uint64_t component = component_size(size_at(accessor, "componentType"));
        if (component == 0)
            fail(at + "/componentType", fmt::format("is {}, which glTF does not have",
                                                    size_at(accessor, "componentType")));
        const std::uint64_t element = element_size(accessor["type"].get<std::string>(), component);
        const std::uint64_t count = size_at(accessor, "count");
        if (accessor.contains("bufferView"))
            fits(at, accessor, count, element);
        else if (count > max_implicit_count)
            fail(at, fmt::format("has {} elements and no buffer view", count));
        if (!accessor.contains("sparse")) continue;

        const json& sparse = accessor["sparse"];
        const std::uint64_t changed = size_at(sparse, "count");
        if (changed > count)
            fail(at + "/sparse", fmt::format("has {} values for {} elements", changed, count));
        const std::uint64_t type = size_at(sparse["indices"], "componentType");
        if (!is_unsigned(type))
            fail(at + "/sparse/indices/componentType",
                 fmt::format("is {}, which is no unsigned integer", type));
        fits(at + "/sparse/indices", sparse["indices"], changed, component_size(type));
        fits(at + "/sparse/values", sparse["values"], changed, element);
    }
}

// glTF 2.0, section 3.6.2.4: a number begins at a multiple of its size.
void Layout::alignment() const {
    LossTally found([](std::size_t count) { return fmt::format(" (in {} accessors)", count); });
    for (std::size_t i = 0; root.contains("accessors") && i < root["accessors"].size(); ++i) {
        const json& accessor = root["accessors"][i];
        if (!accessor.contains("bufferView")) continue;
        const json& view = root["bufferViews"][size_at(accessor, "bufferView")];
        const std::uint64_t component = component_size(size_at(accessor, "componentType"));
        const std::uint64_t start = size_at(view, "byteOffset") + size_at(accessor, "byteOffset");
        if (start % component == 0 && size_at(view, "byteStride") % component == 0) continue;
        found.add({Loss::approximated, fmt::format("{}#/accessors/{}", file, i),
                   "its numbers do not begin at multiples of their size; they are read from where "
                   "they are said to be"});
    }
    std::ranges::copy(found.losses(), std::back_inserter(losses));
}

// Few bytes may describe many elements, and primitives may use them as often as the author likes:
// zeros take no bytes at all, and the elements that a sparse accessor replaces are gone through for
// each primitive.
void Layout::uses() const {
    constexpr std::uint64_t most_zeros = 2 * max_implicit_count, most_replaced = 1 << 28;
    std::uint64_t zeros = 0, replaced = 0;
    const auto add = [&](const json& index) {
        const json& accessor = root["accessors"][index.get<std::size_t>()];
        if (!accessor.contains("bufferView")) zeros += size_at(accessor, "count");
        if (accessor.contains("sparse")) replaced += size_at(accessor["sparse"], "count");
    };
    const auto add_all = [&](const json& attributes) {
        for (const json& index : attributes) add(index);
    };
    for (std::size_t m = 0; root.contains("meshes") && m < root["meshes"].size(); ++m) {
        const json& primitives = root["meshes"][m]["primitives"];
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const json& primitive = primitives[p];
            // What is decompressed has no buffer view either.
            const bool compressed = primitive.contains("extensions") &&
                                    primitive["extensions"].contains("KHR_draco_mesh_compression");
            if (!compressed) add_all(primitive["attributes"]);
            if (!compressed && primitive.contains("indices")) add(primitive["indices"]);
            if (primitive.contains("targets"))
                for (const json& target : primitive["targets"]) add_all(target);
            const auto check = [&](std::uint64_t used, std::uint64_t most, const char* what) {
                if (used > most)
                    fail(fmt::format("/meshes/{}/primitives/{}", m, p),
                         fmt::format("uses {}; with those of the primitives before they are {}, "
                                     "more than the {} that are read",
                                     what, used, most));
            };
            check(zeros, most_zeros, "elements without a buffer view");
            check(replaced, most_replaced, "sparse elements");
        }
    }
}

// glTF 2.0, section 3.5.2: each node has at most one parent, and no node is its own ancestor.
void Layout::trees() const {
    if (!root.contains("nodes")) return;
    const json& nodes = root["nodes"];
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].contains("children")) continue;
        for (const json& child : nodes[i]["children"]) {
            const std::size_t c = child.get<std::size_t>();
            if (parent[c] != nodes.size())
                fail(fmt::format("/nodes/{}", c),
                     fmt::format("is a child of node {} and of node {}", parent[c], i));
            parent[c] = i;
        }
    }
    // What cannot be reached from a node without a parent is part of a cycle.
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] == nodes.size()) open.push_back(i);
    std::vector<bool> reached(nodes.size(), false);
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        reached[i] = true;
        if (!nodes[i].contains("children")) continue;
        for (const json& child : nodes[i]["children"]) open.push_back(child.get<std::size_t>());
    }
    const auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end())
        fail(fmt::format("/nodes/{}", lost - reached.begin()), "is its own ancestor");
}

// glTF 2.0, section 3.5.3: a node has a matrix or the others.
void Layout::transforms() const {
    for (std::size_t i = 0; root.contains("nodes") && i < root["nodes"].size(); ++i) {
        const json& node = root["nodes"][i];
        if (node.contains("matrix") &&
            (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
            losses.push_back(
                {Loss::approximated, fmt::format("{}#/nodes/{}", file, i),
                 "it has a matrix and a translation, rotation or scale; the matrix is used"});
    }
}

}  // namespace

void check_layout(const json& root, const std::string& file, Losses& losses) {
    const Layout layout{root, file, losses};
    layout.views();
    layout.accessors();
    layout.alignment();
    layout.uses();
    layout.trees();
    layout.transforms();
}

}  // namespace penumbra::gltf
