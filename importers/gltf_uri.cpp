// URI -> bytes.
#include "gltf.h"
#include "memory.h"
#include "suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace penumbra::gltf {
namespace {

namespace fs = std::filesystem;

bool equal_ignoring_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// RFC 3986, section 2.1. A '%' without two digits stands for itself.
std::string percent_decoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool escape = text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
                            hex_digit(text[i + 2]) >= 0;
        decoded += escape ? char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2])) : text[i];
        if (escape) i += 2;
    }
    return decoded;
}

constexpr std::array<std::int8_t, 256> base64_values() {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
        values[static_cast<unsigned char>(digits[i])] = std::int8_t(i);
    return values;
}

// RFC 4648, section 4; white space is skipped and the padding may be missing.
std::optional<std::vector<std::byte>> base64_decoded(std::string_view text) {
    static constexpr auto values = base64_values();
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    bool ended = false;
    for (const char c : text) {
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        if (c == '=') {
            ended = true;
            continue;
        }
        const int value = values[static_cast<unsigned char>(c)];
        if (value < 0 || ended) return std::nullopt;
        bits = bits << 6 | std::uint32_t(value);
        count += 6;
        if (count >= 8) bytes.push_back(std::byte(bits >> (count -= 8) & 0xff));
    }
    return bytes;
}

// RFC 2397: data:[<media type>][;base64],<data>
std::vector<std::byte> data_uri(std::string_view uri, const std::string& place) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos)
        throw Error(Failure::input, place, "the data: URI has no comma");
    const std::string_view head = uri.substr(0, comma), data = uri.substr(comma + 1);
    const MemoryClaim claim(2 * data.size(), place);
    constexpr std::string_view mark = ";base64";
    if (head.size() < mark.size() ||
        !equal_ignoring_case(head.substr(head.size() - mark.size()), mark)) {
        const std::string decoded = percent_decoded(data);
        const auto bytes = std::as_bytes(std::span(decoded));
        return {bytes.begin(), bytes.end()};
    }
    // '+', '/' and '=' may be percent-encoded.
    auto bytes = data.find('%') == std::string_view::npos ? base64_decoded(data)
                                                          : base64_decoded(percent_decoded(data));
    if (!bytes) throw Error(Failure::input, place, "the data: URI is not valid base64");
    return std::move(*bytes);
}

// RFC 3986, section 3.1: a letter, then letters, digits, '+', '-' or '.', up to a colon.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0) return false;
    return std::all_of(uri.begin(), uri.begin() + std::ptrdiff_t(colon), [](unsigned char c) {
        return std::isalnum(c) || c == '+' || c == '-' || c == '.';
    });
}

// The file that a relative reference means (RFC 3986, section 4.2).
fs::path local_file(const std::string& uri, const ModelFolders& folders, const std::string& place) {
    const auto refuse = [&](const std::string& why) {
        throw Error(Failure::input, place, fmt::format("the uri '{}' {}", printable(uri), why));
    };
    if (has_scheme(uri)) refuse("is neither a relative path nor a data: URI");
    std::string name = percent_decoded(uri);
    // Windows programs write backslashes.
    std::replace(name.begin(), name.end(), '\\', '/');
    if (name.empty()) refuse("is empty");
    if (std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20; }))
        refuse("has a control character");
    if (name.starts_with("//")) refuse("is on another machine; only local files are read");

    const fs::path path = fs::path(name).lexically_normal();
    const bool inside = path.is_relative() && *path.begin() != "..";
    fs::path file = folders.own / path;
    if ((!inside && folders.allowed.empty()) || !may_read(folders, file))
        refuse(fmt::format("leads out of the model's folder {}", how_to_allow));
    return file;
}

}  // namespace

std::vector<std::byte> fetch(const std::string& uri, const ModelFolders& folders,
                             const std::string& place) {
    if (equal_ignoring_case(std::string_view(uri).substr(0, 5), "data:"))
        return data_uri(uri, place);
    const fs::path file = local_file(uri, folders, place);
    try {
        return read_allowed(folders, file);
    } catch (const MemoryError&) {
        throw;
    } catch (const Error& error) {
        throw Error(Failure::input, place, penumbra::printable(error.what()));
    }
}

}  // namespace penumbra::gltf
