// PNG files through libpng: the default format of pictures and of exported textures does not have
// to wait for OpenImageIO (0.3 s of CPU time and 130 MB).
#pragma once

#include "image/row_encoder.h"

namespace penumbra {

/// Of u8 or u16 samples and 1 to 4 channels, as they are; `frame` needs no data. What `sink` throws
/// is thrown on.
OpenedEncoder open_png_encoder(const Raster& frame, const FileNotes& notes, ByteSink sink);

/// A whole raster. The problem says why there is no file.
struct EncodedPng {
    std::vector<std::byte> file = {};
    std::string problem = {};
};
EncodedPng encode_png(const Raster& raster, bool srgb);

}  // namespace penumbra
