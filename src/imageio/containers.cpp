#include "imageio/containers.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace penumbra {
namespace {

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
    return std::to_integer<std::uint32_t>(bytes[i]);
}

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t i) {
    return byte_at(bytes, i) << 24 | byte_at(bytes, i + 1) << 16 | byte_at(bytes, i + 2) << 8 |
           byte_at(bytes, i + 3);
}

std::uint32_t little_endian(std::span<const std::byte> bytes, std::size_t i) {
    return byte_at(bytes, i + 3) << 24 | byte_at(bytes, i + 2) << 16 | byte_at(bytes, i + 1) << 8 |
           byte_at(bytes, i);
}

std::string_view text(std::span<const std::byte> bytes, std::size_t i, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes.data()) + i, size};
}

// W3C Portable Network Graphics, annex D: the CRC of ISO 3309.
std::uint32_t crc32(std::span<const std::byte> bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> made{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            std::uint32_t c = i;
            for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320U ^ (c >> 1) : c >> 1;
            made[i] = c;
        }
        return made;
    }();
    std::uint32_t c = 0xffffffffU;
    for (const std::byte b : bytes)
        c = table[(c ^ std::to_integer<std::uint32_t>(b)) & 0xff] ^ (c >> 8);
    return ~c;
}

constexpr std::size_t png_signature = 8, png_overhead = 12;  // length, type and CRC of a chunk

}  // namespace

CheckedPng check_png(std::span<const std::byte> file) {
    CheckedPng checked;
    const auto keep = [&](std::size_t from, std::size_t size) {
        const auto part = file.subspan(from, size);
        checked.file.insert(checked.file.end(), part.begin(), part.end());
    };
    keep(0, png_signature);
    std::size_t at = png_signature;
    std::string_view type;
    while (type != "IEND") {
        if (file.size() - at < png_overhead) return {{}, "the file is cut short"};
        const std::size_t length = big_endian(file, at);
        type = text(file, at + 4, 4);
        if (file.size() - at - png_overhead < length) return {{}, "the file is cut short"};
        if (at == png_signature && (type != "IHDR" || length != 13))
            return {{}, "the header is damaged"};
        const bool wanted =
            type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND";
        if (wanted) {
            if (crc32(file.subspan(at + 4, length + 4)) != big_endian(file, at + 8 + length))
                return {{}, "the " + std::string(type) + " chunk is damaged"};
            keep(at, length + png_overhead);
        }
        at += length + png_overhead;
    }
    return checked;
}

// WebP Container Specification; the layout of VP8L's header is in the WebP Lossless Bitstream
// Specification, section 3.
std::vector<std::byte> without_alpha(std::span<const std::byte> webp) {
    constexpr std::byte alpha_flag{0x10};
    std::vector<std::byte> copy(webp.begin(), webp.end());
    bool found = false;
    std::size_t at = 12;
    while (webp.size() >= at + 8) {
        const auto type = text(webp, at, 4);
        const std::size_t size = little_endian(webp, at + 4);
        const std::size_t data = at + 8;
        // In both places the flag is bit 4 of a byte.
        const std::size_t flag = type == "VP8X" ? data : type == "VP8L" ? data + 4 : webp.size();
        if (flag < webp.size() && (webp[flag] & alpha_flag) != std::byte{0}) {
            copy[flag] &= ~alpha_flag;
            found = true;
        }
        if (type == "ALPH") copy[at] = std::byte{'X'};  // unknown chunks are skipped
        if (webp.size() - data < size) break;
        at = data + size + size % 2;
    }
    return found ? copy : std::vector<std::byte>{};
}

}  // namespace penumbra
