#include "exporters/pov/sdl.h"

#include "base/text/ascii.h"
#include "base/text/text.h"

#include <array>
#include <charconv>

namespace penumbra::sdl {

namespace {

constexpr std::size_t longest_word = 48;

template <class... Format>
void append_chars(std::string& out, Format... value) {
    std::array<char, 64> buffer;
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value...);
    out.append(buffer.data(), result.ptr);
}

// Inside a character of several bytes in UTF-8.
bool continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

void append(std::string& out, float value) {
    append_chars(out, value + 0.0F);  // -0 + 0 is 0
}

void append(std::string& out, double value) { append_chars(out, value + 0.0); }

void append(std::string& out, std::size_t value) { append_chars(out, value); }

void append_fixed(std::string& out, float value) {
    const std::size_t start = out.size();
    append_chars(out, double(value) + 0.0, std::chars_format::fixed, 10);
    while (out.back() == '0') out.pop_back();
    if (out.back() == '.') out.pop_back();
    if (out.compare(start, std::string::npos, "-0") == 0) out.erase(start, 1);
}

std::string vector(const Vec3& v) {
    return "<" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ">";
}

std::string color(const Color& c, float transmit) {
    const std::string channels = number(c.x) + ", " + number(c.y) + ", " + number(c.z);
    if (transmit != 0) return "rgbt <" + channels + ", " + number(transmit) + ">";
    if (c.x == c.y && c.y == c.z) return "rgb " + number(c.x);
    return "rgb <" + channels + ">";
}

std::string comment(std::string_view text, std::size_t longest) {
    std::string out;
    for (const char c : text) {
        if (continuation(c)) continue;
        const bool blank = c == '\t' || c == '\n' || c == '\r';
        const char shown = blank ? ' ' : c >= ' ' && c <= '~' ? c : '?';
        const char last = out.empty() ? ' ' : out.back();
        if ((last == '*' && shown == '/') || (last == '/' && shown == '*')) out += ' ';
        out += shown;
    }
    if (out.size() > longest) out.replace(longest - 3, std::string::npos, "...");
    return out;
}

std::string word(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (out.size() == longest_word) break;
        if (is_letter_or_digit(c))
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    while (!out.empty() && out.back() == '_') out.pop_back();
    return out;
}

std::string Names::unique(std::string_view text, std::string_view fallback) {
    std::string name = word(text);
    if (name.empty()) name = fallback;
    int& count = taken_[lower_case(name)];
    if (++count == 1) return name;
    // "box_2" may itself be the name of something.
    for (;; ++count) {
        std::string numbered = name + "_" + std::to_string(count);
        if (taken_.emplace(lower_case(numbered), 1).second) return numbered;
    }
}

}  // namespace penumbra::sdl
