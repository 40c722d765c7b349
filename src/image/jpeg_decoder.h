// JPEG files through libjpeg: most textures of models are such files, and do not have to wait for
// OpenImageIO (0.3 s of CPU time and 130 MB).
#pragma once

#include "image/image_module.h"

namespace penumbra {

/// Do the bytes begin as a JPEG file does?
bool is_jpeg(std::span<const std::byte> file);

/// A scan costs the author of a file a few bytes, and its reader a pass over the whole picture.
bool has_too_many_scans(std::span<const std::byte> jpeg);

/// Reads 8-bit grey or colour without any conversion of colours but that from YCbCr. What is not
/// entirely sound, or is in CMYK, is left to OpenImageIO: `problem` says so.
Decoded decode_jpeg(std::span<const std::byte> file, const MayTake& may_take);

}  // namespace penumbra
