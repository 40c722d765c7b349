// What others have written, so that it can be shown: it stays text and does nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {

/// Length in bytes of the valid UTF-8 character (RFC 3629) at the start of `rest`, which is not
/// empty; 0 if there is none. `code` is its number.
std::size_t utf8_character(std::string_view rest, std::uint32_t& code);

/// `text` on one line that moves no cursor and turns no reading direction: control characters of
/// ASCII become blanks, those beyond ASCII, line separators, marks of direction and what is not
/// UTF-8 '?'.
std::string one_line(std::string_view text);

/// The same line by line.
std::string plain_lines(std::string_view text);

/// `document`, which is JSON, with the same characters as escapes of JSON: it says what it said.
std::string plain_json(std::string_view document);

}  // namespace penumbra
