// Image files by OpenImageIO, written row by row.
#pragma once

#include "image/row_encoder.h"

#include <string>

namespace penumbra {

/// The first sentence of OpenImageIO's `message`, which may have several lines and control
/// characters.
std::string reason(const std::string& message);

/// See ImageModule::open_encoder.
OpenedEncoder open_encoder(const Raster& frame, const std::string& extension,
                           const FileNotes& notes, int descriptor);

}  // namespace penumbra
