// Picture files as compare() takes them: with their alpha, and with what else there is in the file.
#pragma once

#include "penumbra/error.h"
#include "penumbra/image.h"

#include <filesystem>

namespace penumbra {

/// What is done with the alpha of pictures.
enum class Alpha {
    none,     ///< there is none
    counted,  ///< colours are multiplied by it, and it is compared like a channel
    ignored   ///< colours are taken as the file has them
};

struct Picture {
    Image colors = {};  ///< linear; where alpha counts, multiplied by it
    Raster alpha = {};  ///< one channel of the size of `colors`; without data it is 1 everywhere
    Alpha use = Alpha::none;
    /// What of the file was not read: further pages or frames, a colour profile other than sRGB.
    Losses losses = {};
};

/// Reads any image file like load_image(), and its alpha unless that is to be ignored. Whether the
/// file has multiplied its colours already (OpenEXR, TIFF with associated alpha) or not (all
/// others) makes no difference; colours where alpha is 0 become black. Throws Error (input).
Picture load_picture(const std::filesystem::path& file, bool ignore_alpha = false);

}  // namespace penumbra
