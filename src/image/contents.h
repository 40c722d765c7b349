// What a picture file holds beside the samples that are read, from its structure alone.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace penumbra {

struct Contents {
    /// Its colours are multiplied by alpha.
    bool associated_alpha = false;
    /// Clauses: "has 3 frames, and the first is read".
    std::vector<std::string> unread = {};
};

/// Of PNG, JPEG, TIFF, GIF, WebP and OpenEXR files; of others nothing. Never throws for what is
/// malformed: what is behind a defect is not seen.
Contents contents_of(std::span<const std::byte> file);

}  // namespace penumbra
