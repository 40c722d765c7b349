// Small files that describe large things.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace test {

inline constexpr std::size_t mega = std::size_t(1) << 20;

// Sanitizers keep shadows and what was freed, so that peaks say nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

inline bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

inline std::string big_endian(std::uint32_t value, int size = 4) {
    std::string text;
    for (int i = size; i-- > 0;) text += char(value >> (8 * i) & 0xff);
    return text;
}

inline std::string little_endian(std::uint32_t value) {
    const std::string text = big_endian(value);
    return {text.rbegin(), text.rend()};
}

inline std::string chunk(const std::string& type, const std::string& data) {
    const std::string content = type + data;
    const auto crc =
        ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), unsigned(content.size()));
    return big_endian(std::uint32_t(data.size())) + content + big_endian(std::uint32_t(crc));
}

inline std::string deflated(const std::string& data) {
    std::string out(::compressBound(data.size()), '\0');
    auto size = uLongf(out.size());
    ::compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(data.data()), data.size(), 9);
    out.resize(size);
    return out;
}

// Black; `channels` 1 is grey, 4 RGB and alpha.
inline std::string png(std::uint32_t side, int bits, int channels, bool interlaced = false) {
    const std::string header = big_endian(side) + big_endian(side) + char(bits) +
                               char(channels == 4 ? 6 : 0) + '\0' + '\0' + char(interlaced);
    // Rows are equal, so that the first thousands will do: the rest is not looked at.
    const std::string row(1 + (side * std::uint32_t(bits * channels) + 7) / 8, '\0');
    std::string rows;
    while (rows.size() < 8 * mega) rows += row;
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", deflated(rows)) +
           chunk("IEND", "");
}

inline std::string base64(const std::string& text) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < text.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > text.size() ? '=' : digits[bits >> (6 * (3 - k)) & 63];
    }
    return out;
}

// The beginning of a picture in several scans.
inline std::string progressive_jpeg(std::uint32_t width, std::uint32_t height) {
    std::string tables = "\xff\xdb" + big_endian(67, 2) + '\0' + std::string(64, '\1');
    std::string frame = "\xff\xc2" + big_endian(17, 2) + '\x08' + big_endian(height, 2) +
                        big_endian(width, 2) + '\x03';
    for (const char component : {'\1', '\2', '\3'}) frame += std::string{component, '\x11', '\0'};
    std::string codes = "\xff\xc4" + big_endian(20, 2) + '\0' + '\1' + std::string(15, '\0') + '\0';
    const std::string scan =
        "\xff\xda" + big_endian(12, 2) + std::string("\3\1\0\2\0\3\0\0\0\0", 10);
    return "\xff\xd8" + tables + frame + codes + scan + std::string(64, '\x2a');
}

inline std::string attribute(const std::string& name, const std::string& type,
                             const std::string& value) {
    return name + '\0' + type + '\0' + little_endian(std::uint32_t(value.size())) + value;
}

// The beginning of an OpenEXR file with tiles.
inline std::string tiled_exr(std::uint32_t size, std::uint32_t tile) {
    const std::string box =
        little_endian(0) + little_endian(0) + little_endian(size - 1) + little_endian(size - 1);
    std::string channels;
    for (const char* name : {"B", "G", "R"})
        channels += std::string(name) + '\0' + little_endian(2) + std::string(4, '\0') +
                    little_endian(1) + little_endian(1);
    return "\x76\x2f\x31\x01" + little_endian(2 | 0x200) +
           attribute("channels", "chlist", channels + '\0') +
           attribute("compression", "compression", std::string(1, '\0')) +
           attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box) +
           attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           attribute("pixelAspectRatio", "float", std::string("\0\0\x80\x3f", 4)) +
           attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
           attribute("screenWindowWidth", "float", std::string("\0\0\x80\x3f", 4)) +
           attribute("tiles", "tiledesc",
                     little_endian(tile) + little_endian(tile) + std::string(1, '\0')) +
           '\0' + std::string(64, '\0');
}

// The beginning of a lossless WebP picture; sides of at most 16,384.
inline std::string webp(std::uint32_t width, std::uint32_t height) {
    const std::string picture =
        '\x2f' + little_endian((width - 1) | (height - 1) << 14) + std::string(65, '\0');
    const std::string chunk = "VP8L" + little_endian(std::uint32_t(picture.size())) + picture;
    return "RIFF" + little_endian(std::uint32_t(chunk.size() + 4)) + "WEBP" + chunk;
}

inline std::string gltf(const std::string& rest) {
    return R"({"asset":{"version":"2.0"},)" + rest + "}";
}

inline std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    all.reserve(text.size() * count);
    while (count-- > 0) all += text;
    return all;
}

// Accessors without a buffer view are zeros that cost their author nothing.
inline const std::string zeros =
    R"("accessors":[{"componentType":5126,"type":"VEC3","count":16777216}])";

// A file with one triangle of 42 bytes in accessors 0 and 1, and texture coordinates in 2.
inline std::string textured(const std::string& image) {
    return gltf(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
        "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
        "textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
                base64(image) + R"("}],
        "buffers":[{"byteLength":60,"uri":"data:;base64,)" +
                base64(std::string(8, '\0') + std::string(4, '\0') +
                       std::string("\0\0\x80\x3f\0\0\0\0\0\0\0\0", 12) +
                       std::string("\0\0\0\0\0\0\x80\x3f\0\0\0\0", 12) + std::string(24, '\0')) +
                R"("}],"bufferViews":[{"buffer":0,"byteLength":60}],
        "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3},
        {"bufferView":0,"byteOffset":36,"componentType":5126,"type":"VEC2","count":3}])");
}

}  // namespace test
