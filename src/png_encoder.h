// PNG files through libpng: the default format of pictures and of exported textures does not have
// to wait for OpenImageIO (0.3 s of CPU time and 130 MB).
#pragma once

#include "row_encoder.h"

namespace penumbra {

/// Of u8 or u16 samples and 1 to 4 channels, as they are; `frame` needs no data. `srgb` adds the
/// sRGB chunk. What `sink` throws is thrown on.
OpenedEncoder open_png_encoder(const Raster& frame, bool srgb, ByteSink sink);

/// A whole raster. The problem says why there is no file.
struct EncodedPng {
    std::vector<std::byte> file = {};
    std::string problem = {};
};
EncodedPng encode_png(const Raster& raster, bool srgb);

}  // namespace penumbra
