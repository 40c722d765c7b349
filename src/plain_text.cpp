#include "plain_text.h"

#include <fmt/format.h>

#include <array>

namespace penumbra {

namespace {

// A terminal may obey C1 control characters (ECMA-48, section 5.3) as it obeys ESC, and marks of
// direction (Unicode Standard Annex #9, section 2) show text in another order than it has.
bool does_something(std::uint32_t code) {
    return (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

template <class Replace>
std::string replaced(std::string_view text, const Replace& replace) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        std::uint32_t code = 0;
        const std::size_t length = utf8_character(text, code);
        if (length > 0 && code >= 0x20 && !does_something(code))
            result += text.substr(0, length);
        else
            replace(result, length > 0, code);
        text.remove_prefix(length > 0 ? length : 1);
    }
    return result;
}

}  // namespace

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

std::string one_line(std::string_view text) {
    return replaced(text, [](std::string& result, bool valid, std::uint32_t code) {
        result += valid && code <= 0x7f ? ' ' : '?';
    });
}

std::string plain_lines(std::string_view text) {
    return replaced(text, [](std::string& result, bool valid, std::uint32_t code) {
        result += valid && code == '\n' ? '\n' : valid && code <= 0x7f ? ' ' : '?';
    });
}

std::string plain_json(std::string_view document) {
    return replaced(document, [](std::string& result, bool valid, std::uint32_t code) {
        // Between its values JSON has line ends, within them only escapes.
        if (valid && code == '\n')
            result += '\n';
        else
            result += valid ? fmt::format("\\u{:04x}", code) : "\\ufffd";
    });
}

}  // namespace penumbra
