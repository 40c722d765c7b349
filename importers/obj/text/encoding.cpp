#include "importers/obj/text/encoding.h"

#include "base/text/utf8.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace penumbra::obj {

namespace {

// Lone surrogates become U+FFFD, an odd last byte is dropped.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        return std::uint32_t(big_endian ? first << 8 | second : second << 8 | first);
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        if (code >= 0xd800 && code < 0xe000) {
            const std::uint32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
            if (low >= 0xdc00 && low < 0xe000) {
                code = 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00);
                i += 2;
            } else {
                code = 0xfffd;
            }
        }
        append_utf8(text, code);
    }
    return text;
}

std::string from_latin1(std::string_view bytes) {
    std::string text;
    text.reserve(bytes.size() + bytes.size() / 8);
    for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
    return text;
}

// "\r\n" and a lone "\r" become "\n".
void unify_line_ends(std::string& text) {
    std::size_t from = text.find('\r');
    if (from == std::string::npos) return;
    std::size_t to = from;
    for (; from < text.size(); ++from) {
        if (text[from] == '\r' && from + 1 < text.size() && text[from + 1] == '\n') continue;
        text[to++] = text[from] == '\r' ? '\n' : text[from];
    }
    text.resize(to);
}

bool is_high(char c) { return static_cast<unsigned char>(c) >= 0x80; }

// Half-width katakana of Shift-JIS, a byte each.
bool is_katakana(char c) {
    return static_cast<unsigned char>(c) >= 0xa1 && static_cast<unsigned char>(c) < 0xe0;
}

// Whether the backslash at the end of `line` is the second byte of a character: of Shift-JIS, GBK
// or Big5, where a lead is beyond ASCII. A run of such bytes begins with a lead.
bool ends_in_half_character(std::string_view line) {
    std::size_t begin = line.size() - 1;
    while (begin > 0 && is_high(line[begin - 1])) --begin;
    const std::string_view run = line.substr(begin, line.size() - 1 - begin);
    if (run.size() % 2 == 1) return true;
    bool lead = false;  // in Shift-JIS, of the byte before
    for (const char c : run) lead = !lead && !is_katakana(c);
    return lead;
}

// Joins lines that end in a backslash; blank lines follow, so that line numbers stay. Comment
// lines, which may end in a Windows path, are left alone.
std::string join_lines(std::string text, bool utf8) {
    if (text.find("\\\n") == std::string::npos && !text.ends_with('\\')) return text;
    std::string joined;
    joined.reserve(text.size());
    std::size_t pending = 0;  // line ends to make up for
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        const std::size_t start = line.find_first_not_of(" \t");
        const bool comment = pending == 0 && start != line.npos && line[start] == '#';
        const bool last = end == text.size();
        at = end + 1;
        if (!comment && line.ends_with('\\') && (utf8 || !ends_in_half_character(line))) {
            (joined += line.substr(0, line.size() - 1)) += ' ';
            ++pending;
        } else {
            joined += line;
            joined.append(last ? pending : pending + 1, '\n');
            pending = 0;
        }
    }
    return joined;
}

// The bytes that from_latin1() has made `text` of; none where it cannot have.
std::optional<std::string> latin1_bytes(std::string_view text) {
    std::string bytes;
    while (!text.empty()) {
        std::uint32_t code = 0;
        const std::size_t length = utf8_character(text, code);
        if (length == 0 || code > 0xff) return {};
        bytes += char(code);
        text.remove_prefix(length);
    }
    return bytes;
}

// `text` in another encoding; none where it is not in `from`.
std::optional<std::string> converted(const char* from, const char* to, std::string text) {
    const iconv_t conversion = ::iconv_open(to, from);
    if (conversion == iconv_t(-1)) return {};
    std::string result(4 * text.size(), '\0');
    char *in = text.data(), *out = result.data();
    std::size_t in_left = text.size(), out_left = result.size();
    const bool whole = ::iconv(conversion, &in, &in_left, &out, &out_left) == 0 && in_left == 0 &&
                       ::iconv(conversion, nullptr, nullptr, &out, &out_left) == 0;
    ::iconv_close(conversion);
    if (!whole) return {};
    result.resize(result.size() - out_left);
    return result;
}

// Those in which programs that know no UTF-8 write what is not ASCII: GBK, Shift-JIS, Big5, Korean,
// Cyrillic.
constexpr std::array<const char*, 5> encodings = {"GB18030", "CP932", "BIG5-HKSCS", "CP949",
                                                  "CP1251"};
constexpr std::size_t longest_name = 4096;

}  // namespace

std::string to_lines(std::string bytes) {
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
        bytes = from_utf16(std::string_view(bytes).substr(2), bytes[0] == '\xfe');
    } else if (bytes.size() >= 2 && (bytes[0] == '\0') != (bytes[1] == '\0')) {
        bytes = from_utf16(bytes, bytes[0] == '\0');  // no byte order mark, but starts with ASCII
    } else if (bytes.starts_with("\xef\xbb\xbf")) {
        bytes.erase(0, 3);
    }
    const bool utf8 = is_utf8(bytes);
    unify_line_ends(bytes);
    bytes = join_lines(std::move(bytes), utf8);
    return utf8 ? bytes : from_latin1(bytes);
}

std::string in_utf8(const std::string& text) { return is_utf8(text) ? text : from_latin1(text); }

std::vector<Decoded> decodings(std::string_view name) {
    std::vector<Decoded> result;
    if (name.size() > longest_name || is_ascii(name)) return result;
    const std::optional<std::string> bytes = latin1_bytes(name);
    if (!bytes) return result;
    for (const char* encoding : encodings)
        if (const auto text = converted(encoding, "UTF-8", *bytes))
            result.push_back({.encoding = encoding, .text = *text});
    return result;
}

std::string encoded(const Decoded& name) {
    return converted("UTF-8", name.encoding, name.text).value_or("");
}

std::string as_bytes(std::string_view name) { return latin1_bytes(name).value_or(""); }

}  // namespace penumbra::obj
