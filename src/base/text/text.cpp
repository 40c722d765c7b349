#include "base/text/text.h"

#include "base/text/utf8.h"

#include <fmt/format.h>

#include <cstdint>

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

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = lower_case(c);
    return result;
}

std::string lower_extension(const std::filesystem::path& file) {
    return lower_case(file.extension().string());
}

std::string_view trimmed(std::string_view text, std::string_view blanks) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
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

std::string printable(std::string_view text, std::size_t longest) {
    const std::string_view start = utf8_start(text, longest);
    std::string line =
        replaced(start, [](std::string& result, bool, std::uint32_t) { result += '?'; });
    if (start.size() < text.size()) line += "...";
    return line;
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
