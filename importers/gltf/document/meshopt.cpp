// EXT_meshopt_compression and KHR_meshopt_compression -> plain buffer views.
#include "base/loss_tally.h"
#include "base/memory.h"
#include "importers/gltf/document/compression.h"
#include "importers/gltf/document/document.h"

#include <fmt/format.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

const std::array<std::string, 2> names = {"KHR_meshopt_compression", "EXT_meshopt_compression"};

const json* meshopt_of(const json& object) {
    for (const std::string& name : names)
        if (object.contains("extensions") && object["extensions"].contains(name))
            return &object["extensions"][name];
    return nullptr;
}

// What a buffer view says of its compressed data.
struct Compressed {
    std::string place;  // "box.gltf#/bufferViews/0/extensions/EXT_meshopt_compression"
    Bytes data;
    std::size_t count, stride;
    std::string mode, filter;

    [[noreturn]] void fail(const std::string& problem) const {
        throw Error(Failure::input, place, problem);
    }
    void check() const;
    std::vector<std::byte> decode() const;
};

// The rules of the extensions' section "JSON schema updates"; the library relies on them.
void Compressed::check() const {
    const auto need = [&](bool right, const char* what) {
        if (!right)
            fail(fmt::format("has the byteStride {}, but {} needs {}", stride,
                             mode == "ATTRIBUTES" && filter != "NONE" ? filter : mode, what));
    };
    if (mode == "ATTRIBUTES") {
        need(stride >= 4 && stride <= 256 && stride % 4 == 0, "a multiple of 4 up to 256");
        if (filter == "OCTAHEDRAL" || filter == "COLOR") need(stride == 4 || stride == 8, "4 or 8");
        if (filter == "QUATERNION") need(stride == 8, "8");
    } else {
        need(stride == 2 || stride == 4, "2 or 4");
        if (filter != "NONE") fail(fmt::format("has the filter {} in mode {}", filter, mode));
        if (mode == "TRIANGLES" && count % 3 != 0)
            fail(fmt::format("has {} indices, which are no whole triangles", count));
    }
    // The codecs cannot do better, so that a small file cannot ask for much memory: a block of at
    // most 256 elements takes a byte for every four of an element, an index a third of a byte.
    constexpr std::size_t best = 1024;
    if (count > data.size() * best / stride)
        fail(fmt::format("has {} elements of {} bytes in {} bytes, which cannot be", count, stride,
                         data.size()));
}

// KHR_meshopt_compression, appendix B, filter 4: luma and chroma of K bits, and alpha of K - 1 bits
// below a bit that tells K.
template <class T>
void decode_colors(std::vector<std::byte>& bytes) {
    using Signed = std::make_signed_t<T>;
    for (std::size_t at = 0; at + 4 * sizeof(T) <= bytes.size(); at += 4 * sizeof(T)) {
        std::array<T, 4> in;
        std::memcpy(in.data(), bytes.data() + at, sizeof in);
        const int scale = int(std::bit_ceil(std::uint32_t(in[3]) + 1) - 1);
        const int y = in[0], co = Signed(in[1]), cg = Signed(in[2]), alpha = in[3] & (scale >> 1);
        const std::array<int, 4> rgba = {y + co - cg, y + cg, y - co - cg,
                                         alpha << 1 | (alpha & 1)};
        const float largest = float(std::numeric_limits<T>::max());
        for (std::size_t c = 0; c < 4; ++c) {
            const float value = float(rgba[c]) * (largest / float(std::max(scale, 1)));
            in[c] = T(std::clamp(std::round(value), 0.0F, largest));
        }
        std::memcpy(bytes.data() + at, in.data(), sizeof in);
    }
}

std::vector<std::byte> Compressed::decode() const {
    const auto* const from = reinterpret_cast<const unsigned char*>(data.data());
    const MemoryClaim claim(2 * count * stride, place);
    std::vector<std::byte> bytes(count * stride);
    int failure = 0;
    // Version 1 is newer than the library.
    if (mode == "ATTRIBUTES" && !data.empty() && from[0] == 0xa1) {
        bytes = decode_vertices_v1(data, count, stride);
        failure = bytes.empty() ? 1 : 0;
    } else if (mode == "ATTRIBUTES") {
        failure = meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, data.size());
    } else if (mode == "TRIANGLES") {
        failure = meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, data.size());
    } else {
        failure = meshopt_decodeIndexSequence(bytes.data(), count, stride, from, data.size());
    }
    if (failure != 0) fail(fmt::format("its {} bytes are no valid {} data", data.size(), mode));

    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    if (filter == "COLOR" && stride == 4) decode_colors<std::uint8_t>(bytes);
    if (filter == "COLOR" && stride == 8) decode_colors<std::uint16_t>(bytes);
    return bytes;
}

Compressed compressed(const Document& document, const json& extension, const std::string& pointer) {
    Compressed found = {.place = document.place(pointer),
                        .data = {},
                        .count = extension["count"].get<std::size_t>(),
                        .stride = extension["byteStride"].get<std::size_t>(),
                        .mode = extension["mode"].get<std::string>(),
                        .filter = extension.value("filter", "NONE")};
    const auto buffer = extension["buffer"].get<std::size_t>();
    const auto offset = extension.value("byteOffset", std::size_t(0)),
               length = extension["byteLength"].get<std::size_t>();
    const Bytes all = document.buffers[buffer];
    if (all.empty()) found.fail(fmt::format("buffer {} has no content", buffer));
    if (offset > all.size() || length > all.size() - offset)
        found.fail(fmt::format("ends at byte {} of buffer {}, which has {}", offset + length,
                               buffer, all.size()));
    found.data = all.subspan(offset, length);
    found.check();
    return found;
}

// EXT_meshopt_compression, section "Mode 0": attributes have version 0. KHR_meshopt_compression has
// version 1 as well.
bool breaks_version(const Compressed& source, const std::string& name) {
    return name == "EXT_meshopt_compression" && source.mode == "ATTRIBUTES" &&
           !source.data.empty() && source.data.front() == std::byte(0xa1);
}

// The view becomes one of a new buffer that has what is decompressed.
void decompress(Document& document, json& root, json& view, const Compressed& source) {
    if (source.count * source.stride < view["byteLength"].get<std::size_t>())
        source.fail(fmt::format("has {} bytes, fewer than the byteLength {} of its buffer view",
                                source.count * source.stride, view["byteLength"].dump()));
    document.storage.push_back(source.decode());
    document.buffers.emplace_back(document.storage.back());
    root["buffers"].push_back({{"byteLength", document.buffers.back().size()}});
    view["buffer"] = document.buffers.size() - 1;
    view["byteOffset"] = 0;
}

}  // namespace

std::vector<bool> fallback_buffers(const json& root) {
    std::vector<bool> fallback;
    if (!root.contains("buffers")) return fallback;
    for (const json& buffer : root["buffers"]) {
        const json* const extension = meshopt_of(buffer);
        fallback.push_back(extension != nullptr && extension->value("fallback", false));
    }
    if (!root.contains("bufferViews")) return fallback;
    for (const json& view : root["bufferViews"])
        if (meshopt_of(view) == nullptr) fallback[view["buffer"].get<std::size_t>()] = false;
    return fallback;
}

void decode_meshopt(Document& document, json& root, Losses& losses) {
    if (!root.contains("bufferViews")) return;
    LossTally found([](std::size_t count) { return fmt::format(" (in {} buffer views)", count); });
    json& views = root["bufferViews"];
    for (std::size_t i = 0; i < views.size(); ++i)
        for (const std::string& name : names) {
            if (!views[i].contains("extensions") || !views[i]["extensions"].contains(name))
                continue;
            const Compressed source =
                compressed(document, views[i]["extensions"][name],
                           fmt::format("/bufferViews/{}/extensions/{}", i, name));
            if (breaks_version(source, name))
                found.add({Loss::approximated, source.place,
                           "its data have version 1 of the attribute codec, which only "
                           "KHR_meshopt_compression allows; they are read as if it were that"});
            decompress(document, root, views[i], source);
            views[i]["extensions"].erase(name);
            break;
        }
    std::ranges::copy(found.losses(), std::back_inserter(losses));
}

}  // namespace penumbra::gltf
