#include "image/oiio/containers.h"

#include <cstdint>
#include <string_view>

namespace penumbra {
namespace {

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
    return std::to_integer<std::uint32_t>(bytes[i]);
}

std::uint32_t little_endian(std::span<const std::byte> bytes, std::size_t i) {
    return byte_at(bytes, i + 3) << 24 | byte_at(bytes, i + 2) << 16 | byte_at(bytes, i + 1) << 8 |
           byte_at(bytes, i);
}

std::string_view text(std::span<const std::byte> bytes, std::size_t i, std::size_t size) {
    return {reinterpret_cast<const char*>(bytes.data()) + i, size};
}

}  // namespace

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
