// URI -> bytes.
#include "importers/gltf/document/uri.h"

#include "base/base64.h"
#include "base/memory.h"
#include "base/text/ascii.h"
#include "base/text/text.h"
#include "importers/gltf/document/text.h"
#include "importers/shared/file_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::gltf {
namespace {

namespace fs = std::filesystem;

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

// RFC 2397: data:[<media type>][;base64],<data>
std::vector<std::byte> data_uri(std::string_view uri, const std::string& place) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos)
        throw Error(Failure::input, place, "the data: URI has no comma");
    const std::string_view head = uri.substr(0, comma), data = uri.substr(comma + 1);
    const MemoryClaim claim(2 * data.size(), place);
    constexpr std::string_view mark = ";base64";
    if (lower_case(head.substr(head.size() - std::min(head.size(), mark.size()))) != mark) {
        const std::string decoded = percent_decoded(data);
        const auto bytes = std::as_bytes(std::span(decoded));
        return {bytes.begin(), bytes.end()};
    }
    // '+', '/' and '=' may be percent-encoded.
    auto bytes = data.find('%') == std::string_view::npos ? from_base64(data)
                                                          : from_base64(percent_decoded(data));
    if (!bytes) throw Error(Failure::input, place, "the data: URI is not valid base64");
    return std::move(*bytes);
}

// RFC 3986, section 3.1: a letter, then letters, digits, '+', '-' or '.', up to a colon.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0) return false;
    return std::all_of(uri.begin(), uri.begin() + std::ptrdiff_t(colon), [](char c) {
        return is_letter_or_digit(c) || c == '+' || c == '-' || c == '.';
    });
}

bool is_data(std::string_view uri) { return lower_case(uri.substr(0, 5)) == "data:"; }

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
        refuse("leads out of " + folders.description());
    file = find_spelled(folders, file);
    if (!may_read(folders, file)) refuse("leads out of " + folders.description());
    return file;
}

}  // namespace

std::optional<fs::path> file_of(const std::string& uri, const ModelFolders& folders,
                                const std::string& place) {
    if (is_data(uri)) return std::nullopt;
    return local_file(uri, folders, place);
}

std::optional<fs::path> named_file(const std::string& uri, const ModelFolders& folders) {
    try {
        return file_of(uri, folders, "");
    } catch (const Error&) {
        return std::nullopt;
    }
}

std::vector<std::byte> fetch(const std::string& uri, const ModelFolders& folders,
                             const std::string& place) {
    if (is_data(uri)) return data_uri(uri, place);
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
