// Spellings of the same text in Unicode.
#pragma once

#include <string>
#include <string_view>

namespace penumbra {

/// `text` with its letters and marks apart and in order: what is canonically equivalent, such as é
/// as one character (NFC, most programs) and as two (NFD, files by macOS), becomes the same. Bytes
/// that are not UTF-8 stay. The Unicode Standard, section 3.11 and 3.12, in the Basic Multilingual
/// Plane without ideographs for compatibility.
std::string decomposed(std::string_view text);

}  // namespace penumbra
