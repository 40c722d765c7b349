#include "base/text/utf8.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

namespace penumbra {

std::size_t utf8_character(std::string_view rest, std::uint32_t& code) {
    const auto byte = [&](std::size_t i) { return std::uint32_t(std::uint8_t(rest[i])); };
    const std::uint32_t lead = byte(0);
    const std::size_t length = lead < 0x80            ? 1
                               : lead >> 5 == 0b110   ? 2
                               : lead >> 4 == 0b1110  ? 3
                               : lead >> 3 == 0b11110 ? 4
                                                      : 0;
    if (length == 0 || length > rest.size()) return 0;
    code = length == 1 ? lead : lead & (0x7fU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if (byte(i) >> 6 != 0b10) return 0;
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr std::array<std::uint32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < least[length] || code > 0x10ffff || surrogate ? 0 : length;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        // Eight bytes of ASCII at a time: nearly all of every file.
        std::uint64_t block = 0;
        if (text.size() >= sizeof block) {
            std::memcpy(&block, text.data(), sizeof block);
            if ((block & 0x8080808080808080U) == 0) {
                text.remove_prefix(sizeof block);
                continue;
            }
        }
        std::uint32_t code = 0;
        const std::size_t length = utf8_character(text, code);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

bool is_ascii(std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

void append_utf8(std::string& text, std::uint32_t code) {
    assert(code <= 0x10ffff);
    const auto tail = [&](int shift) { text += char(0x80 | ((code >> shift) & 0x3f)); };
    if (code < 0x80) {
        text += char(code);
    } else if (code < 0x800) {
        text += char(0xc0 | (code >> 6));
        tail(0);
    } else if (code < 0x10000) {
        text += char(0xe0 | (code >> 12));
        tail(6), tail(0);
    } else {
        text += char(0xf0 | (code >> 18));
        tail(12), tail(6), tail(0);
    }
}

std::string_view utf8_start(std::string_view text, std::size_t size) {
    if (text.size() <= size) return text;
    while (size > 0 && (text[size] & '\xc0') == '\x80') --size;
    return text.substr(0, size);
}

}  // namespace penumbra
