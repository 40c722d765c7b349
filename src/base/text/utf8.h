// UTF-8 (RFC 3629).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra {

/// Length in bytes of the valid character at the start of `rest`, which is not empty; 0 if there is
/// none. `code` is its number.
std::size_t utf8_character(std::string_view rest, std::uint32_t& code);

bool is_utf8(std::string_view text);

/// Also true for no text at all.
bool is_ascii(std::string_view text);

/// Precondition: `code` is at most 0x10ffff.
void append_utf8(std::string& text, std::uint32_t code);

/// The first `size` bytes of `text`, or a few less: a character is not cut.
std::string_view utf8_start(std::string_view text, std::size_t size);

}  // namespace penumbra
