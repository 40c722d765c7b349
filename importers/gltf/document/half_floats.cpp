// Accessors of 16-bit floats (KHR_accessor_float16, glTF 2.1) -> accessors of floats.
#include "base/memory.h"
#include "importers/gltf/document/compression.h"
#include "importers/gltf/document/document.h"

#include <fmt/format.h>
#include <half.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <utility>

namespace penumbra::gltf {
namespace {

using nlohmann::json;

constexpr int half_type = 5131, float_type = 5126;

// How many numbers a column of an element has, and how many columns.
std::pair<std::size_t, std::size_t> shape_of(const std::string& type) {
    if (type == "SCALAR") return {1, 1};
    const auto n = std::size_t(type.back() - '0');
    return {n, type[0] == 'V' ? 1 : n};
}

float half_at(const std::byte* from) {
    std::uint16_t bits = 0;
    std::memcpy(&bits, from, sizeof bits);
    half value;
    value.setBits(bits);
    return value;
}

// `count` elements of 16-bit floats become a buffer of floats, one element after the other. `slice`
// is an accessor, or the values of a sparse one: it refers to that buffer afterwards.
void widen(Document& document, json& root, json& slice, const json& accessor, std::size_t count) {
    const json& view = root["bufferViews"][slice["bufferView"].get<std::size_t>()];
    const Bytes buffer = document.buffers[view["buffer"].get<std::size_t>()];
    if (buffer.empty()) return;  // what reads it says so
    const auto [rows, columns] = shape_of(accessor["type"].get<std::string>());
    // glTF 2.0, section 3.6.2.4: each column of a matrix starts at a multiple of four bytes.
    const std::size_t column = columns == 1 ? 2 * rows : (2 * rows + 3) / 4 * 4;
    const std::size_t element = column * (columns - 1) + 2 * rows;
    const std::size_t stride = view.value("byteStride", element);
    const std::byte* from = buffer.data() + view.value("byteOffset", std::size_t(0)) +
                            slice.value("byteOffset", std::size_t(0));
    const std::size_t size = times(times(count, rows * columns), sizeof(float));
    const MemoryClaim claim(size, document.file);
    std::vector<std::byte>& bytes = document.storage.emplace_back(size);
    std::byte* to = bytes.data();
    for (std::size_t i = 0; i < count; ++i, from += stride)
        for (std::size_t c = 0; c < columns; ++c)
            for (std::size_t r = 0; r < rows; ++r, to += sizeof(float)) {
                const float value = half_at(from + c * column + 2 * r);
                std::memcpy(to, &value, sizeof value);
            }
    document.buffers.emplace_back(bytes);
    root["buffers"].push_back({{"byteLength", size}});
    root["bufferViews"].push_back(
        {{"buffer", document.buffers.size() - 1}, {"byteOffset", 0}, {"byteLength", size}});
    slice["bufferView"] = root["bufferViews"].size() - 1;
    slice["byteOffset"] = 0;
}

}  // namespace

void widen_half_floats(Document& document, json& root) {
    if (!root.contains("accessors")) return;
    for (json& accessor : root["accessors"]) {
        if (accessor["componentType"] != half_type) continue;
        if (accessor.contains("bufferView"))
            widen(document, root, accessor, accessor, accessor["count"].get<std::size_t>());
        if (accessor.contains("sparse"))
            widen(document, root, accessor["sparse"]["values"], accessor,
                  accessor["sparse"]["count"].get<std::size_t>());
        accessor["componentType"] = float_type;
    }
}

}  // namespace penumbra::gltf
