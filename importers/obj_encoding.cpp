#include "obj.h"
#include "suggest.h"

#include <algorithm>
#include <cstring>

namespace penumbra::obj {

namespace {

void append_utf8(std::string& text, char32_t code) {
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

// Lone surrogates become U+FFFD, an odd last byte is dropped.
std::string from_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        return char32_t(big_endian ? first << 8 | second : second << 8 | first);
    };
    std::string text;
    text.reserve(bytes.size() / 2);
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        char32_t code = unit(i);
        if (code >= 0xd800 && code < 0xe000) {
            const char32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
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

// A row of RFC 3629's table of well-formed sequences; bytes after the second are 80 to bf.
struct Utf8Row {
    unsigned first_lead = 0, last_lead = 0, least_second = 0x80, most_second = 0xbf;
    std::size_t length = 1;
};
constexpr auto utf8_rows = std::to_array<Utf8Row>({
    {0x00, 0x7f},
    {0xc2, 0xdf, 0x80, 0xbf, 2},
    {0xe0, 0xe0, 0xa0, 0xbf, 3},
    {0xe1, 0xec, 0x80, 0xbf, 3},
    {0xed, 0xed, 0x80, 0x9f, 3},
    {0xee, 0xef, 0x80, 0xbf, 3},
    {0xf0, 0xf0, 0x90, 0xbf, 4},
    {0xf1, 0xf3, 0x80, 0xbf, 4},
    {0xf4, 0xf4, 0x80, 0x8f, 4},
});

// Number of bytes of the UTF-8 sequence at `at`; 0 if it is not valid.
std::size_t sequence_length(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) {
        return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
    };
    for (const Utf8Row& row : utf8_rows) {
        if (byte(0) < row.first_lead || byte(0) > row.last_lead) continue;
        for (std::size_t i = 1; i < row.length; ++i) {
            const unsigned least = i == 1 ? row.least_second : 0x80;
            const unsigned most = i == 1 ? row.most_second : 0xbf;
            if (byte(i) < least || byte(i) > most) return 0;
        }
        return row.length;
    }
    return 0;
}

bool is_utf8(std::string_view text) {
    std::size_t i = 0;
    while (i < text.size()) {
        // Eight bytes of ASCII at a time: nearly all of every file.
        std::uint64_t block = 0;
        if (i + sizeof block <= text.size()) {
            std::memcpy(&block, text.data() + i, sizeof block);
            if (!(block & 0x8080808080808080U)) {
                i += sizeof block;
                continue;
            }
        }
        const std::size_t length = sequence_length(text, i);
        if (length == 0) return false;
        i += length;
    }
    return true;
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

}  // namespace

std::string to_utf8(std::string bytes) {
    if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
        bytes = from_utf16(std::string_view(bytes).substr(2), bytes[0] == '\xfe');
    } else if (bytes.size() >= 2 && (bytes[0] == '\0') != (bytes[1] == '\0')) {
        bytes = from_utf16(bytes, bytes[0] == '\0');  // no byte order mark, but starts with ASCII
    } else if (bytes.starts_with("\xef\xbb\xbf")) {
        bytes.erase(0, 3);
    }
    if (!is_utf8(bytes)) bytes = from_latin1(bytes);
    unify_line_ends(bytes);
    return bytes;
}

std::string join_lines(std::string text) {
    if (text.ends_with('\\')) text.back() = ' ';
    if (text.find("\\\n") == std::string::npos) return text;
    std::string joined;
    joined.reserve(text.size());
    std::size_t pending = 0;  // line ends to make up for
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        at = end + 1;
        if (pending == 0 && line.find_first_not_of(" \t") != std::string_view::npos &&
            line[line.find_first_not_of(" \t")] == '#') {
            (joined += line) += '\n';
        } else if (line.ends_with('\\')) {
            (joined += line.substr(0, line.size() - 1)) += ' ';
            ++pending;
        } else {
            joined += line;
            joined.append(pending + 1, '\n');
            pending = 0;
        }
    }
    return joined;
}

std::string printable(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::size_t size = std::min(text.size(), longest);
    while (size < text.size() && size > 0 && (text[size] & '\xc0') == '\x80') --size;
    const std::string result = penumbra::printable(text.substr(0, size));
    return size < text.size() ? result + "..." : result;
}

}  // namespace penumbra::obj
