#include "image/oiio/containers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace penumbra {
namespace {

using Bytes = std::span<const std::byte>;

// Numbers and names of a header, one after the other; behind the end there are zeros.
struct Cursor {
    Bytes bytes;
    std::size_t at = 0;

    bool ended() const { return at >= bytes.size(); }
    std::uint64_t byte() { return ended() ? 0 : std::to_integer<std::uint64_t>(bytes[at++]); }
    std::uint64_t little(int size) {
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) value |= byte() << (8 * i);
        return value;
    }
    std::uint64_t big(int size) {
        std::uint64_t value = 0;
        for (int i = 0; i < size; ++i) value = value << 8 | byte();
        return value;
    }
    std::string_view text(std::size_t size) {
        size = std::min(size, bytes.size() - std::min(at, bytes.size()));
        const std::string_view found(reinterpret_cast<const char*>(bytes.data()) + at, size);
        at += size;
        return found;
    }
    // Up to a zero, or to the end.
    std::string_view name() {
        const std::size_t start = at;
        std::size_t length = 0;
        while (byte() != 0) ++length;
        if (length == 0) return {};
        return {reinterpret_cast<const char*>(bytes.data()) + start, length};
    }
};

// The product, and the largest number instead of one beyond it.
std::size_t product(std::initializer_list<std::uint64_t> factors) {
    std::uint64_t result = 1;
    for (const std::uint64_t factor : factors)
        result = factor != 0 && result > UINT64_MAX / factor ? UINT64_MAX : result * factor;
    return std::size_t(result);
}

// OpenEXR File Layout, sections "Header Attributes" and "Predefined Attribute Types".
struct ExrHeader {
    std::uint64_t width = 0, height = 0, tile = 0;  // in pixels
    std::uint64_t pixel = 0;                        // in bytes

    void read(std::string_view name, Bytes value) {
        Cursor cursor{value};
        if (name == "dataWindow") {
            std::array<std::int64_t, 4> box = {};  // least x and y, greatest x and y
            for (std::int64_t& side : box) side = std::int32_t(cursor.little(4));
            width = std::uint64_t(std::max<std::int64_t>(box[2] - box[0] + 1, 0));
            height = std::uint64_t(std::max<std::int64_t>(box[3] - box[1] + 1, 0));
        } else if (name == "tiles") {
            const std::uint64_t x = cursor.little(4);
            tile = product({x, cursor.little(4)});
        } else if (name == "channels") {
            while (!cursor.name().empty()) {
                pixel += cursor.little(4) == 1 ? 2 : 4;  // half; uint and float
                cursor.at += 12;
            }
        }
    }
};

Opening exr_opening(Bytes file) {
    constexpr std::uint64_t lines = 256, copies = 3;  // of a compressed block at most; of a buffer
    Cursor cursor{file, 8};
    ExrHeader header;
    while (!cursor.ended()) {
        const std::string_view name = cursor.name();
        if (name.empty()) break;
        cursor.name();  // its type
        const auto size = std::size_t(cursor.little(4));
        if (cursor.at > file.size() || size > file.size() - cursor.at) break;
        header.read(name, file.subspan(cursor.at, size));
        cursor.at += size;
    }
    const std::uint64_t block = std::max(header.tile, product({header.width, lines}));
    return {.pixels = std::max(header.tile, product({header.width, header.height})),
            .memory = product({block, header.pixel, copies})};
}

// WebP Container Specification, and section 9.1 of RFC 6386 and section 3 of the lossless format's.
Opening webp_opening(Bytes file) {
    constexpr std::uint64_t channels = 4, copies = 3;  // the canvas, the last one, the frame
    Cursor cursor{file, 12};
    const std::string_view type = cursor.text(4);
    cursor.at += 4;
    std::uint64_t width = 0, height = 0;
    if (type == "VP8X") {
        cursor.at += 4;
        width = cursor.little(3) + 1;
        height = cursor.little(3) + 1;
    } else if (type == "VP8L") {
        cursor.at += 1;
        const std::uint64_t packed = cursor.little(4);
        width = (packed & 0x3fff) + 1;
        height = (packed >> 14 & 0x3fff) + 1;
    } else {
        cursor.at += 6;
        width = cursor.little(2) & 0x3fff;
        height = cursor.little(2) & 0x3fff;
    }
    return {product({width, height}), product({width, height, channels, copies})};
}

Opening gif_opening(Bytes file) {
    constexpr std::uint64_t channels = 4, copies = 2;
    Cursor cursor{file, 6};
    const std::uint64_t width = cursor.little(2), height = cursor.little(2);
    return {product({width, height}), product({width, height, channels, copies})};
}

// ISO/IEC 15444-1: the box "ihdr" of a file, or the marker segment SIZ of a bare codestream.
Opening jpeg2000_opening(Bytes file) {
    constexpr std::uint64_t sample = 4, copies = 2;
    constexpr std::size_t far = 4096;
    Cursor cursor{file};
    const std::size_t box = cursor.text(std::min(file.size(), far)).find("ihdr");
    cursor.at = box == std::string_view::npos ? 8 : box + 4;
    const std::uint64_t one = cursor.big(4), other = cursor.big(4);
    if (box == std::string_view::npos) cursor.at = 40;
    return {product({one, other}), product({one, other, cursor.big(2), sample, copies})};
}

// ISO/IEC 23008-12: the boxes "ispe" of a file's pictures, alpha and thumbnails among them.
Opening heif_opening(Bytes file) {
    constexpr std::uint64_t channels = 4, copies = 3;
    constexpr std::size_t far = 65536;
    Cursor cursor{file};
    const std::string_view start = cursor.text(std::min(file.size(), far));
    std::uint64_t pixels = 0;
    for (std::size_t at = 0; (at = start.find("ispe", at)) != std::string_view::npos; at += 4) {
        cursor.at = at + 8;
        const std::uint64_t width = cursor.big(4);
        pixels = std::max(pixels, product({width, cursor.big(4)}));
    }
    return {pixels, product({pixels, channels, copies})};
}

}  // namespace

Opening opening_of(Bytes file, const std::string& format) {
    if (format == "openexr") return exr_opening(file);
    if (format == "webp") return webp_opening(file);
    if (format == "gif") return gif_opening(file);
    if (format == "jpeg2000") return jpeg2000_opening(file);
    if (format == "avif" || format == "heif" || format == "heic") return heif_opening(file);
    return {};
}

}  // namespace penumbra
