// Small glTF files made in a test, and what reading them gives.
#pragma once

#include "support/support.h"

#include "penumbra/importers.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace test {

using nlohmann::json;

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t j = 0; j < 3; ++j)
            bits = bits << 8 | (i + j < bytes.size() ? std::uint8_t(bytes[i + j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[bits >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

template <class T>
int component_type() {
    if (std::is_same_v<T, float>) return 5126;
    const int size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 2 : 4;
    return 5120 + size + (std::is_unsigned_v<T> ? 1 : 0);
}

/// One buffer, whose content grows with every accessor.
struct Gltf {
    json root = {{"asset", {{"version", "2.0"}}}};
    std::string bin = {};

    template <class T>
    int view(const std::vector<T>& values, const json& members = {}) {
        bin.resize((bin.size() + 3) / 4 * 4);
        json view = {
            {"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (members.is_object()) view.update(members);
        bin.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        root["bufferViews"].push_back(view);
        return int(root["bufferViews"].size()) - 1;
    }

    int add(const char* key, const json& object) {
        root[key].push_back(object);
        return int(root[key].size()) - 1;
    }

    template <class T>
    int accessor(const std::string& type, const std::vector<T>& values, const json& members = {}) {
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "MAT4" ? 16
                                                   : std::size_t(type.back() - '0');
        json accessor = {{"bufferView", view(values)},
                         {"componentType", component_type<T>()},
                         {"count", values.size() / width},
                         {"type", type}};
        if (members.is_object()) accessor.update(members);
        return add("accessors", accessor);
    }

    /// A mesh of one primitive, and a node with it in scene 0.
    json& show(const json& primitive) {
        add("meshes", {{"primitives", {primitive}}});
        const int node = add("nodes", {{"mesh", int(root["meshes"].size()) - 1}});
        root["scene"] = 0;
        if (!root.contains("scenes")) root["scenes"] = {{{"nodes", json::array()}}};
        root["scenes"][0]["nodes"].push_back(node);
        return root["meshes"].back()["primitives"][0];
    }

    std::string text() const {
        json all = root;
        if (!bin.empty() && !all.contains("buffers"))
            all["buffers"] = {{{"byteLength", bin.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bin)}}};
        return all.dump();
    }

    std::string glb() const {
        json all = root;
        if (!bin.empty() && !all.contains("buffers"))
            all["buffers"] = {{{"byteLength", bin.size()}}};
        std::string text = all.dump(), content = bin;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        content.resize((content.size() + 3) / 4 * 4);
        const auto word = [](std::size_t value) {
            std::string bytes;
            for (int i = 0; i < 4; ++i) bytes += char(value >> (8 * i) & 0xff);
            return bytes;
        };
        std::string chunks = word(text.size()) + "JSON" + text;
        if (!content.empty()) chunks += word(content.size()) + std::string("BIN\0", 4) + content;
        return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
    }
};

inline const std::vector<float> corner = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/// One triangle in the plane z = 0.
inline Gltf triangle() {
    Gltf gltf;
    const int positions = gltf.accessor("VEC3", corner);
    gltf.show({{"attributes", {{"POSITION", positions}}}});
    return gltf;
}

/// Reads `content` from a file box.gltf (or box.glb) in a folder of its own. In messages the folder
/// is left out.
inline penumbra::Imported read_content(const std::string& content,
                                       const std::string& name = "box.gltf",
                                       const penumbra::ModelOptions& options = {}) {
    const TempDir folder;
    const fs::path file = write(folder / name, content);
    const auto cut = [&](std::string text) {
        const std::string prefix = folder.path.string() + "/";
        for (std::size_t at; (at = text.find(prefix)) != std::string::npos;)
            text.erase(at, prefix.size());
        return text;
    };
    try {
        auto imported = penumbra::read_gltf(file, options);
        for (penumbra::Loss& loss : imported.losses) {
            loss.place = cut(loss.place);
            loss.what = cut(loss.what);
        }
        return imported;
    } catch (const penumbra::Error& error) {
        throw penumbra::Error(error.failure, "", cut(error.what()));
    }
}
inline penumbra::Imported read(const Gltf& gltf, const penumbra::ModelOptions& options = {}) {
    return read_content(gltf.text(), "box.gltf", options);
}

/// The message of the Error that reading throws.
inline std::string problem(const std::string& content, const std::string& name = "box.gltf") {
    return message_of([&] { read_content(content, name); });
}
inline std::string problem(const Gltf& gltf) { return problem(gltf.text()); }

}  // namespace test
