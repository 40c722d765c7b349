// Pictures: linear float images, textures in their own bit depth, and their files.
//
// PNG, and reading JPEG, need nothing else. All other formats go through OpenImageIO, which lives
// in a module that is loaded when the first file of one of them is read or written (it costs 0.3 s
// to start; see penumbra/image_module.h).
#pragma once

#include "penumbra/math.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// Row-major, top row first, linear RGB, unclamped.
struct Image {
    int width = 0, height = 0;
    std::vector<Color> pixels = {};  ///< width * height

    Image() = default;
    Image(int w, int h) : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), Color(0)) {}

    Color& at(int x, int y) { return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)]; }
    const Color& at(int x, int y) const {
        return pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
    }
};

/// Sample type of a Raster; the value is its size in bytes.
enum class Depth { u8 = 1, u16 = 2, f32 = 4 };

/// Samples as a file holds them: row-major, top row first, channels interleaved, native byte
/// order. 1 channel is grey, 2 grey + alpha, 3 RGB, 4 RGB + alpha (straight, not premultiplied).
struct Raster {
    int width = 0, height = 0, channels = 0;
    Depth depth = Depth::u8;
    std::vector<std::byte> data = {};  ///< width * height * channels * size of depth

    std::size_t texels() const { return std::size_t(width) * std::size_t(height); }
};

/// Reads any image file as linear RGB: 8 and 16 bit integers are sRGB-decoded, floats are taken as
/// linear. Alpha is dropped. Throws Error (input).
Image load_image(const std::filesystem::path& file);

/// The samples of an image file held in memory; `name` is for messages. Throws Error (input).
Raster decode_image(std::span<const std::byte> file, const std::string& name);

struct SaveOptions {
    int bits = 8;  ///< integer formats that can: 8 or 16
};

/// True when `file` has an extension that save_image() can write:
/// .png .exr .tif .tiff .jpg .jpeg .hdr
bool can_save_image(const std::filesystem::path& file);

/// Writes `image` in the format of the extension: .exr (float32) and .hdr linear and unclamped (but
/// .hdr has no negative values), the others clamped to [0, 1] and sRGB-encoded. Written beside the
/// target and renamed, so that a failure leaves what was there. Precondition: image.pixels has
/// width * height elements. Throws Error (output), of an empty picture too.
void save_image(const std::filesystem::path& file, const Image& image,
                const SaveOptions& options = {});

/// Writes `raster` as it is, as .png (u8, u16) or .exr (f32), with `comment`, ASCII, near the
/// beginning of the file unless it is empty. Precondition: its data are as long as its size says.
/// Throws Error (output), of an empty picture too.
void save_raster(const std::filesystem::path& file, const Raster& raster,
                 const std::string& comment = "");

/// `image` as an 8-bit sRGB PNG in memory, for embedding in a report. Throws Error (output).
std::vector<std::byte> encode_png(const Image& image);

}  // namespace penumbra
