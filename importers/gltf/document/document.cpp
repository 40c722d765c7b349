// File -> Document.
#include "importers/gltf/document/document.h"

#include "base/memory.h"
#include "importers/gltf/document/checks.h"
#include "importers/gltf/document/compression.h"
#include "importers/gltf/document/container.h"
#include "importers/gltf/document/schema.h"
#include "importers/gltf/document/uri.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

// The file that a buffer or an image names, whether it is read or not.
void note_file(Document& document, const json& object) {
    if (!object.contains("uri")) return;
    const auto& uri = object["uri"].get_ref<const std::string&>();
    if (auto file = named_file(uri, document.folders)) document.files.push_back(std::move(*file));
}

// The buffers' bytes, each cut to the byteLength that was checked against.
void load_buffers(Document& document, json& root, Bytes bin) {
    if (!root.contains("buffers")) return;
    json& buffers = root["buffers"];
    const std::vector<bool> fallback = fallback_buffers(root);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        json& buffer = buffers[i];
        const std::string place = document.place(fmt::format("/buffers/{}", i));
        const auto length = buffer["byteLength"].get<std::size_t>();
        note_file(document, buffer);
        // glTF 2.0, section 3.6.1: a buffer may be left for an extension to fill.
        if (fallback[i] || (!buffer.contains("uri") && (i > 0 || bin.empty()))) {
            document.buffers.emplace_back();
            continue;
        }
        Bytes bytes = bin;
        if (buffer.contains("uri")) {
            // A data: URI may be most of the file; it is not kept twice.
            const std::string uri = std::exchange(buffer["uri"].get_ref<std::string&>(), {});
            document.storage.push_back(fetch(uri, document.folders, place));
            bytes = document.storage.back();
        }
        if (bytes.size() < length)
            throw Error(
                Failure::input, place,
                fmt::format("has {} bytes, but its byteLength is {}", bytes.size(), length));
        document.buffers.push_back(bytes.first(length));
    }
}

void list_images(Document& document, json& root) {
    if (!root.contains("images")) return;
    for (json& image : root["images"]) {
        note_file(document, image);
        std::string uri;
        if (image.contains("uri")) uri = std::exchange(image["uri"].get_ref<std::string&>(), {});
        document.images.push_back({.name = image.value("name", ""),
                                   .uri = std::move(uri),
                                   .view = image.value("bufferView", -1)});
    }
}

// glTF 2.1, draft of 2026: nodes may show other glTF files.
void list_external_assets(Document& document, const json& root) {
    if (!root.contains("externalAssets") || !root.contains("nodes")) return;
    for (const json& asset : root["externalAssets"]) {
        const json& file = root["files"][asset["file"].get<std::size_t>()];
        document.external_assets.push_back({.name = file.value("name", ""),
                                            .uri = file.value("uri", ""),
                                            .view = file.value("bufferView", -1)});
    }
    const json& nodes = root["nodes"];
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].contains("externalAsset"))
            document.asset_of_node[int(i)] = nodes[i]["externalAsset"].get<int>();
}

void refuse_write(std::string* error) {
    if (error != nullptr) *error = "nothing is written";
}

// tinygltf gets no names of files; should a version of it open some all the same, it finds none.
tinygltf::FsCallbacks no_files() {
    tinygltf::FsCallbacks files{};
    files.FileExists = [](const std::string&, void*) { return false; };
    files.ExpandFilePath = [](const std::string& path, void*) { return path; };
    files.ReadWholeFile = [](std::vector<unsigned char>*, std::string* error, const std::string&,
                             void*) {
        refuse_write(error);
        return false;
    };
    files.WriteWholeFile = [](std::string* error, const std::string&,
                              const std::vector<unsigned char>&, void*) {
        refuse_write(error);
        return false;
    };
    return files;
}

// Since tinygltf 2.9 a fifth callback is needed.
template <class Callbacks>
void add_size_callback(Callbacks& files) {
    if constexpr (requires { files.GetFileSizeInBytes; })
        files.GetFileSizeInBytes = [](std::size_t*, std::string*, const std::string&, void*) {
            return false;
        };
}

// What the text of `value` and the structures that tinygltf makes of it take of memory. Its nesting
// is bounded.
std::size_t structure_size(const json& value) {
    constexpr std::size_t object = 1280, number = 128;  // of a Node or Accessor; of a Value
    std::size_t bytes = number;
    if (value.is_string()) bytes += 4 * value.get_ref<const std::string&>().size();
    if (value.is_object()) bytes += object;
    if (value.is_structured())
        for (const json& part : value) bytes += structure_size(part);
    return bytes;
}

constexpr int no_node = int(largest_int);

void say_default_spots(json& root) {
    const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
    if (!root.contains(lights)) return;
    for (json& light : root[lights])
        if (!light.contains("spot")) light["spot"] = json::object();
}

// JSON -> structures. Some things that tinygltf 2.7 refuses although they are valid or harmless are
// kept from it: buffers without content, accessors without a buffer view that serve as indices,
// strides that are no multiple of four, spot lights with all defaults, animations of no node.
tinygltf::Model parse_model(json root, const std::string& file) {
    for (const char* key : {"buffers", "images"}) root.erase(key);
    const MemoryClaim claim(structure_size(root), file);
    json& views = root["bufferViews"];
    if (!views.is_array()) views = json::array();
    const std::size_t view_count = views.size();
    std::vector<std::size_t> strides;
    for (json& view : views) {
        strides.push_back(view.value("byteStride", std::size_t(0)));
        view.erase("byteStride");
    }
    views.push_back({{"buffer", 0}, {"byteLength", 0}});
    say_default_spots(root);
    if (root.contains("accessors"))
        for (json& accessor : root["accessors"])
            if (!accessor.contains("bufferView")) accessor["bufferView"] = view_count;
    if (root.contains("animations"))
        for (json& animation : root["animations"])
            for (json& channel : animation["channels"])
                if (!channel["target"].contains("node")) channel["target"]["node"] = no_node;

    tinygltf::TinyGLTF parser;
    auto files = no_files();
    add_size_callback(files);
    parser.SetFsCallbacks(files);
    tinygltf::Model model;
    std::string error, warning;
    const std::string text = root.dump();
    if (!parser.LoadASCIIFromString(&model, &error, &warning, text.c_str(), unsigned(text.size()),
                                    ""))
        throw Error(Failure::input, file,
                    "tinygltf refuses it: " + printable(error.substr(0, error.find('\n'))));

    model.bufferViews.pop_back();
    for (std::size_t i = 0; i < view_count; ++i) model.bufferViews[i].byteStride = strides[i];
    for (tinygltf::Accessor& accessor : model.accessors)
        if (accessor.bufferView == int(view_count)) accessor.bufferView = -1;
    for (tinygltf::Animation& animation : model.animations)
        for (tinygltf::AnimationChannel& channel : animation.channels)
            if (channel.target_node == no_node) channel.target_node = -1;
    return model;
}

// KHR_animation_pointer.
bool has_pointers(const json& root) {
    if (!root.contains("animations")) return false;
    for (const json& animation : root["animations"])
        for (const json& channel : animation["channels"])
            if (channel["target"]["path"] == "pointer") return true;
    return false;
}

}  // namespace

Document open_document(FileContent content, Losses& losses, const Amend& amend) {
    Document document;
    document.file = std::move(content.name);
    document.folders = std::move(content.folders);
    document.storage.push_back(std::move(content.owned));
    const Container parts = split_container(content.bytes, document.file, losses);

    json root = parse_json(parts.json, document.file, losses);
    check_asset(root, document.file, losses);
    check_schema(root, document.file, losses);
    check_layout(root, document.file, losses);
    check_rules(root, document.file, losses);
    load_buffers(document, root, parts.bin);
    decode_meshopt(document, root, losses);
    widen_half_floats(document, root);
    decode_draco(document, root, losses);
    list_images(document, root);
    list_external_assets(document, root);
    // The text of a .gltf is no longer needed; a .glb's chunk is.
    if (parts.bin.empty()) document.storage.front() = {};
    MemoryClaim claim;
    json animated;
    if (amend && has_pointers(root)) {
        claim = MemoryClaim(structure_size(root), document.file);
        animated = root;
    }
    document.model = parse_model(std::move(root), document.file);
    if (!animated.is_null() && amend(document, animated)) {
        check_schema(animated, document.file, losses);  // the values are within their limits too
        document.model = parse_model(std::move(animated), document.file);
    }
    return document;
}

std::vector<std::byte> image_bytes(const Document& document, const ImageSource& image,
                                   const std::string& place) {
    if (image.view < 0) return fetch(image.uri, document.folders, place);
    const tinygltf::BufferView& view = document.model.bufferViews[std::size_t(image.view)];
    const Bytes buffer = document.buffers[std::size_t(view.buffer)];
    if (buffer.empty()) throw Error(Failure::input, place, "its buffer has no content");
    const Bytes slice = buffer.subspan(view.byteOffset, view.byteLength);
    const MemoryClaim claim(slice.size(), place);
    return {slice.begin(), slice.end()};
}

}  // namespace penumbra::gltf
