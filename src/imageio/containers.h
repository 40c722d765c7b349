// File structure that must be looked at before a decoder sees the file.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

/// A PNG with only the chunks that its samples depend on. libpng prints to stderr about damaged
/// chunks and about many harmless colour profiles, and a library should not; so damage is found
/// here, and profiles, texts and dates are left out.
struct CheckedPng {
    std::vector<std::byte> file = {};
    std::string problem = {};  ///< empty: success
};
CheckedPng check_png(std::span<const std::byte> file);

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
