// While POV-Ray renders to a file it keeps "<output stem>.pov-state" beside it, from which it can
// continue: a header of 512 bytes, then one message for each finished block of pixels
// (POV-Ray 3.7: source/frontend/renderfrontend.cpp and imagemessagehandler.cpp write it,
// source/base/povms.cpp encodes it). All numbers are big-endian.
#include "validation/povray/render_state.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace penumbra {
namespace {

constexpr std::string_view header = "POV-Ray Render State File";
constexpr std::size_t header_size = 512;
constexpr std::size_t floats_per_pixel = 5;  // red, green, blue, filter, transmit

// Reads on from a position; false from any function means that the bytes do not suffice.
struct Reader {
    std::span<const std::byte> rest;

    bool take(std::size_t count, std::span<const std::byte>& out) {
        if (rest.size() < count) return false;
        out = rest.first(count);
        rest = rest.subspan(count);
        return true;
    }
    bool number(std::uint32_t& out) {
        std::span<const std::byte> bytes;
        if (!take(4, bytes)) return false;
        out = 0;
        for (const std::byte byte : bytes) out = out << 8 | std::to_integer<std::uint32_t>(byte);
        return true;
    }
};

// Keys and types are four characters.
constexpr std::uint32_t code(std::string_view text) {
    std::uint32_t result = 0;
    for (const char c : text) result = result << 8 | std::uint8_t(c);
    return result;
}

// One block of pixels, if the message holds one. Bounds are inclusive.
struct Block {
    std::array<std::uint32_t, 4> bounds = {};  // left, top, right, bottom
    unsigned bounds_found = 0;                 // one bit each
    std::span<const std::byte> pixels = {};
};

constexpr std::array bound_keys = {code("Left"), code("Top "), code("Righ"), code("Bott")};

bool skip_value(Reader& in, int depth);

bool skip_object(Reader& in, std::uint32_t count, bool keyed, int depth) {
    if (depth > 16) return false;
    for (std::uint32_t i = 0, key = 0; i < count; ++i)
        if ((keyed && !in.number(key)) || !skip_value(in, depth + 1)) return false;
    return true;
}

bool value(Reader& in, std::uint32_t& type, std::span<const std::byte>& data, int depth) {
    std::uint32_t length = 0;
    if (!in.number(type) || !in.number(length)) return false;
    const std::size_t size = length;
    switch (type) {
    case code("OBJE"):
    case code("RESU"): return skip_object(in, length, true, depth);
    case code("LIST"): return skip_object(in, length, false, depth);
    case code("INT4"):
    case code("FLT4"):
    case code("TYPE"): return in.take(4, data);
    case code("INT8"):
    case code("LON8"): return in.take(8, data);
    case code("BOOL"): return in.take(1, data);
    case code("VFL4"):
    case code("VIN4"):
    case code("VTYP"): return in.take(4 * size, data);
    case code("VIN8"): return in.take(8 * size, data);
    default: return in.take(size, data);
    }
}

bool skip_value(Reader& in, int depth) {
    std::uint32_t type = 0;
    std::span<const std::byte> data;
    return value(in, type, data, depth);
}

bool read_message(Reader in, Block& block) {
    std::uint32_t type = 0, count = 0;
    if (!in.number(type) || type != code("OBJE") || !in.number(count)) return false;
    for (std::uint32_t i = 0, key = 0; i < count; ++i) {
        std::span<const std::byte> data;
        if (!in.number(key) || !value(in, type, data, 0)) return false;
        if (key == code("PBlo") && type == code("VFL4")) block.pixels = data;
        for (std::size_t side = 0; side < bound_keys.size(); ++side) {
            if (key != bound_keys[side] || type != code("INT4")) continue;
            Reader{data}.number(block.bounds[side]);
            block.bounds_found |= 1U << side;
        }
    }
    return true;
}

float big_endian_float(const std::byte* bytes) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 8 | std::to_integer<std::uint32_t>(bytes[i]);
    return std::bit_cast<float>(bits);
}

bool place(const Block& block, Image& image, std::vector<bool>& known) {
    const auto [left, top, right, bottom] = block.bounds;
    if (block.bounds_found != 15 || right < left || bottom < top) return false;
    if (right >= std::uint32_t(image.width) || bottom >= std::uint32_t(image.height)) return false;
    const std::size_t count = std::size_t(right - left + 1) * (bottom - top + 1);
    if (block.pixels.size() != count * floats_per_pixel * 4) return false;
    const std::byte* from = block.pixels.data();
    for (std::uint32_t y = top; y <= bottom; ++y) {
        for (std::uint32_t x = left; x <= right; ++x, from += 4 * floats_per_pixel) {
            const std::size_t at = std::size_t(y) * std::size_t(image.width) + x;
            image.pixels[at] = {big_endian_float(from), big_endian_float(from + 4),
                                big_endian_float(from + 8)};
            known[at] = true;
        }
    }
    return true;
}

}  // namespace

std::optional<Image> decode_render_state(std::span<const std::byte> file, int width, int height) {
    Reader in{file};
    std::span<const std::byte> head, body;
    if (width <= 0 || height <= 0 || !in.take(header_size, head)) return std::nullopt;
    if (std::memcmp(head.data(), header.data(), header.size()) != 0) return std::nullopt;

    Image image(width, height);
    std::vector<bool> known(image.pixels.size());
    while (!in.rest.empty()) {
        // Some messages start with a mark and a version, all with their size and encoding.
        std::span<const std::byte> mark;
        if (in.rest.size() >= 12 && std::memcmp(in.rest.data(), "POVRAYMS", 8) == 0)
            in.take(12, mark);
        std::uint32_t size = 0, encoding = 0;
        if (!in.number(size) || !in.number(encoding) || !in.take(size, body)) return std::nullopt;
        Block block;
        if (!read_message(Reader{body}, block)) return std::nullopt;
        if (!block.pixels.empty() && !place(block, image, known)) return std::nullopt;
    }
    for (const bool pixel : known)
        if (!pixel) return std::nullopt;
    return image;
}

double render_state_size(int width, int height) {
    const int across = (width + 31) / 32, down = (height + 31) / 32;
    const double blocks = double(across) * down;
    return double(header_size) + 4.0 * floats_per_pixel * width * height + 160 * blocks;
}

}  // namespace penumbra
