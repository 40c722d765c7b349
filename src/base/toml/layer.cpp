// Sidecar files and KEY=VALUE settings -> Layer.
#include "base/file.h"
#include "base/memory.h"
#include "base/text/ascii.h"
#include "base/text/text.h"
#include "base/toml/section.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra {

namespace {

constexpr std::size_t deepest_key = 16;  // none has half as many parts

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
            result.path.push_back(quoted ? word : std::string(trimmed(word)));
            if (result.path.back().empty() || result.path.size() > deepest_key) return std::nullopt;
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
    const auto digit = [&](std::size_t i) { return i < text.size() && is_digit(text[i]); };
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

// Walks through TOML text, part of a key by part of a key: strings, bare words and numbers.
struct KeyParts {
    std::string_view text;
    std::size_t at = 0, line = 1;
    std::size_t parts = 0;  // of what may be a key, so far
    bool joined = false;    // a dot stands before

    bool starts(std::string_view with) const { return text.substr(at).starts_with(with); }
    void skip_to(std::string_view end, bool escapes) {
        while (at < text.size() && !starts(end)) {
            line += text[at] == '\n' ? 1 : 0;
            at += escapes && text[at] == '\\' ? 2 : 1;
        }
        at = std::min(at + end.size(), text.size());
    }
    void part() {
        parts = joined ? parts + 1 : 1;
        joined = false;
    }
    void step();
};

void KeyParts::step() {
    constexpr std::string_view bare = "_-+";
    const char c = text[at];
    if (c == '#') {
        while (at < text.size() && text[at] != '\n') ++at;
    } else if (c == '"' || c == '\'') {
        const std::string three(3, c);
        const auto end = starts(three) ? three : three.substr(0, 1);
        at += end.size();
        skip_to(end, c == '"');
        part();
    } else if (is_letter_or_digit(c) || bare.find(c) != bare.npos ||
               static_cast<unsigned char>(c) >= 0x80) {
        while (at < text.size() &&
               (is_letter_or_digit(text[at]) || bare.find(text[at]) != bare.npos ||
                static_cast<unsigned char>(text[at]) >= 0x80))
            ++at;
        part();
    } else {
        joined = c == '.' || (joined && (c == ' ' || c == '\t'));
        line += c == '\n' ? 1 : 0;
        ++at;
    }
}

// toml++ bounds the nesting of values, but not of tables by their keys, and recurses over them.
void check_keys(std::string_view text, const std::string& name) {
    KeyParts walk = {text};
    while (walk.at < text.size()) {
        walk.step();
        if (walk.parts > deepest_key)
            throw Error(Failure::input, fmt::format("{}:{}", name, walk.line),
                        fmt::format("a key has more than {} parts", deepest_key));
    }
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
    constexpr std::uintmax_t max_size = std::uintmax_t(64) << 20;
    constexpr std::size_t most_of_a_byte = 48;  // of toml++'s nodes: "0,"
    const std::string text = read_text(file, max_size);
    const MemoryClaim claim(text.size() * most_of_a_byte, printable(file.string()));
    Layer layer = {.name = printable(file.string()), .folder = file.parent_path()};
    check_keys(text, layer.name);
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
    Layer layer = {.name = fmt::format("setting '{}'", printable(setting)), .setting = true};
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
