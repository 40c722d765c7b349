// File structure that must be looked at before a decoder sees the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// What reading takes as soon as a file is opened, before a decoder tells how large the picture is:
/// what the header of an OpenEXR, WebP, GIF or JPEG 2000 file calls for; of others nothing.
struct Opening {
    std::size_t pixels = 0;  ///< of the picture or of a tile of it
    std::size_t memory = 0;  ///< bytes
};
Opening opening_of(std::span<const std::byte> file, const std::string& format);

/// A copy of a WebP file that claims to have no alpha, so that its colours are decoded as they are
/// stored, straight; empty when the file has no alpha. OpenImageIO always multiplies them by it.
std::vector<std::byte> without_alpha(std::span<const std::byte> webp);

}  // namespace penumbra
