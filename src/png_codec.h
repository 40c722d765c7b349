// PNG files through libpng: the default format of pictures and of exported textures does not have
// to wait for OpenImageIO (0.3 s of CPU time and 130 MB).
#pragma once

#include "image_module.h"

namespace penumbra {

/// Do the bytes begin as a PNG file does?
bool is_png(std::span<const std::byte> file);

/// Reads 1 to 16 bits per sample, grey, RGB or palette, with or without alpha (straight), as u8 or
/// u16 without any conversion of colours.
Decoded decode_png(std::span<const std::byte> file);

/// Writes a u8 or u16 raster of 1 to 4 channels as it is. `srgb` adds the sRGB chunk.
Encoded encode_png(const Raster& raster, bool srgb);

}  // namespace penumbra
