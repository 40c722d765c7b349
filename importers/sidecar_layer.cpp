// Sidecar files and KEY=VALUE settings -> Layer.
#include "file.h"
#include "sidecar_reader.h"
#include "suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace penumbra {

namespace {

std::string trimmed(std::string_view text) {
    constexpr std::string_view blank = " \t";
    const auto first = text.find_first_not_of(blank);
    if (first == std::string_view::npos) return "";
    return std::string(text.substr(first, text.find_last_not_of(blank) - first + 1));
}

// The words of a dotted key and what follows the '=' after it.
struct Assignment {
    std::vector<std::string> path = {};
    std::string value = {};
};

std::optional<Assignment> split(std::string_view text) {
    Assignment result;
    std::string word;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if ((c == '"' || c == '\'') && trimmed(word).empty() && !quoted) {
            const auto end = text.find(c, i + 1);
            if (end == std::string_view::npos) return std::nullopt;
            word = text.substr(i + 1, end - i - 1);
            quoted = true;
            i = end;
        } else if (c == '.' || c == '=') {
            result.path.push_back(quoted ? word : trimmed(word));
            constexpr std::size_t deepest = 16;  // no key has half as many words
            if (result.path.back().empty() || result.path.size() > deepest) return std::nullopt;
            word.clear();
            quoted = false;
            if (c == '.') continue;
            result.value = trimmed(text.substr(i + 1));
            return result;
        } else {
            word += c;
        }
    }
    return std::nullopt;
}

// TOML wants a digit before the decimal point; people write .5.
std::string with_leading_zeros(std::string_view text) {
    const auto digit = [&](std::size_t i) {
        return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
    };
    std::string result;
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote != 0 ? c == quote : c == '"' || c == '\'') quote = quote != 0 ? '\0' : c;
        const bool bare = quote == 0 && c == '.' && digit(i + 1) && (i == 0 || !digit(i - 1)) &&
                          (i == 0 || std::string_view("[,=+- ").find(text[i - 1]) != text.npos);
        if (bare) result += '0';
        result += c;
    }
    return result;
}

std::string one_sentence(const toml::parse_error& error) {
    std::string text = printable(error.description());
    while (!text.empty() && (text.back() == '.' || text.back() == ' ')) text.pop_back();
    return text;
}

// `text` as a TOML value, or as the string that it is.
toml::table value_of(const std::string& text, const std::string& place) {
    try {
        toml::table parsed = toml::parse("value = " + with_leading_zeros(text));
        if (parsed.size() == 1 && text.find_first_of("\r\n") == text.npos) return parsed;
    } catch (const toml::parse_error& error) {
        if (!text.empty() && std::string_view("[{\"'").find(text[0]) != std::string_view::npos)
            throw Error(Failure::usage, place, "not a TOML value: " + one_sentence(error));
    }
    return toml::table{{"value", text}};
}

}  // namespace

Layer read_sidecar(const std::filesystem::path& file) {
    const std::string text = read_text(file);
    Layer layer = {.name = printable(file.string()), .folder = file.parent_path()};
    try {
        layer.table = toml::parse(text, layer.name);
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw Error(Failure::input, fmt::format("{}:{}:{}", layer.name, at.line, at.column),
                    one_sentence(error));
    }
    return layer;
}

Layer read_setting(const std::string& setting) {
    Layer layer = {.name = "--set " + printable(setting), .setting = true};
    const auto parts = split(setting);
    if (!parts)
        throw Error(Failure::usage, layer.name, "must be KEY=VALUE, such as lighting.ambient=0.1");
    layer.text = parts->value;
    toml::table nest = value_of(parts->value, layer.name);
    toml::table inner;
    inner.insert(parts->path.back(), std::move(*nest.get("value")));
    for (std::size_t i = parts->path.size() - 1; i > 0; --i) {
        toml::table outer;
        outer.insert(parts->path[i - 1], std::move(inner));
        inner = std::move(outer);
    }
    layer.table = std::move(inner);
    return layer;
}

}  // namespace penumbra
