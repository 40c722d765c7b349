// Text: its letters, its ends, and what others have written made fit to be shown, so that it stays
// text and does nothing.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra {

/// A letter of ASCII in lower case; anything else as it is.
constexpr char lower_case(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }
std::string lower_case(std::string_view text);

/// ".png" of "a/B.PNG"; empty where there is none.
std::string lower_extension(const std::filesystem::path& file);

/// `text` without the `blanks` at its ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

/// `text` on one line that moves no cursor and turns no reading direction: control characters of
/// ASCII become blanks, those beyond ASCII, line separators, marks of direction and what is not
/// UTF-8 '?'.
std::string one_line(std::string_view text);

/// The same line by line.
std::string plain_lines(std::string_view text);

/// The same for words that are quoted: control characters become '?' as well, so that they show.
/// What is beyond `longest` bytes is "...".
std::string printable(std::string_view text, std::size_t longest = std::string_view::npos);

/// `document`, which is JSON, with the same characters as escapes of JSON: it says what it said.
std::string plain_json(std::string_view document);

}  // namespace penumbra
