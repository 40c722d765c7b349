// Bytes -> JSON text and BIN chunk.
#include "importers/gltf/document/container.h"

#include <fmt/format.h>

namespace penumbra::gltf {
namespace {

constexpr std::uint32_t chunk_json = 0x4E4F534A, chunk_bin = 0x004E4942;
constexpr std::size_t header_size = 12, chunk_header_size = 8;

// glTF 2.0, section 4: all numbers of the container are little-endian.
std::uint32_t word(Bytes bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::uint32_t(bytes[at + i]);
    return value;
}

std::string_view as_text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

[[noreturn]] void fail(const std::string& file, const std::string& problem) {
    throw Error(Failure::input, file, problem);
}

void need(Bytes content, std::size_t size, const std::string& before, const std::string& file) {
    if (content.size() < size)
        fail(file, fmt::format("the file ends before {} (needs {} bytes, has {})", before, size,
                               content.size()));
}

Container split_glb(Bytes content, const std::string& file, Losses& losses) {
    need(content, header_size, "the end of the GLB header", file);
    const std::uint32_t version = word(content, 4);
    if (version == 3)
        fail(file,
             "is GLB 3, the container of glTF 2.1, which is not supported: save it as GLB 2 or "
             ".gltf");
    if (version != 2)
        fail(file,
             fmt::format("GLB container version {} is not supported, only version 2 is", version));
    const std::size_t length = word(content, 8);
    need(content, length, "the length that its header gives", file);
    if (length < content.size()) {
        losses.push_back(
            {Loss::dropped, file,
             fmt::format("{} bytes after the model are ignored", content.size() - length)});
        content = content.first(length);
    }

    Container parts;
    bool json_seen = false, bin_seen = false;
    for (std::size_t at = header_size; at < content.size();) {
        need(content, at + chunk_header_size, "the end of a chunk header", file);
        const std::size_t size = word(content, at);
        const std::uint32_t type = word(content, at + 4);
        at += chunk_header_size;
        need(content, at + size,
             type == chunk_json  ? "the end of its JSON chunk"
             : type == chunk_bin ? "the end of its BIN chunk"
                                 : "the end of a chunk",
             file);
        if (!json_seen && type != chunk_json) fail(file, "the first GLB chunk is not JSON");
        if (type == chunk_json && json_seen) fail(file, "there is a second JSON chunk");
        if (type == chunk_bin && bin_seen) fail(file, "there is a second BIN chunk");
        if (type == chunk_json) parts.json = as_text(content.subspan(at, size));
        if (type == chunk_bin) parts.bin = content.subspan(at, size);
        json_seen = true;
        bin_seen = bin_seen || type == chunk_bin;
        at += size;
    }
    if (!json_seen) fail(file, "the GLB has no JSON chunk");
    return parts;
}

}  // namespace

Container split_container(Bytes content, const std::string& file, Losses& losses) {
    if (content.empty()) fail(file, "the file is empty");
    if (as_text(content).substr(0, 4) == "glTF") return split_glb(content, file, losses);
    return {.json = as_text(content)};
}

}  // namespace penumbra::gltf
