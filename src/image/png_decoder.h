// PNG files through libpng: the most common format of textures does not have to wait for
// OpenImageIO (0.3 s of CPU time and 130 MB).
#pragma once

#include "image/image_module.h"

namespace penumbra {

/// Do the bytes begin as a PNG file does?
bool is_png(std::span<const std::byte> file);

/// Reads 1 to 16 bits per sample, grey, RGB or palette, with or without alpha (straight), as u8 or
/// u16 without any conversion of colours.
Decoded decode_png(std::span<const std::byte> file, const MayTake& may_take);

}  // namespace penumbra
