#include "cli/options/values.h"

#include "base/text/ascii.h"

#include "penumbra/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace penumbra::cli {
namespace {

constexpr int longest_side = 32767;  // of a picture that POV-Ray renders

[[noreturn]] void refuse(const std::string& option, std::string_view text,
                         const std::string& wanted) {
    throw Error(Failure::usage, option, fmt::format("'{}' is not {}", text, wanted));
}

template <class Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return {};
    return value;
}

std::string described(const char* kind, Interval range) {
    return std::isinf(range.high) ? fmt::format("{} of {} or more", kind, range.low)
                                  : fmt::format("{} from {} to {}", kind, range.low, range.high);
}

bool is_plain(const std::string& word) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,=:+@%";
    return !word.empty() && word.find_first_not_of(plain) == std::string::npos;
}

constexpr const char* box_form = "X0,Y0,X1,Y1 in whole pixels with X0 < X1 and Y0 < Y1";

// POSIX shell's quoting (IEEE 1003.1, section 2.2) without any expansion.
std::vector<std::string> split_words(const std::string& option, const std::string& text) {
    std::vector<std::string> words;
    bool in_word = false;
    char quote = '\0';
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool escapes = c == '\\' && quote != '\'';
        if (quote == '\0' && (c == ' ' || c == '\t' || c == '\n')) {
            in_word = false;
            continue;
        }
        if (!in_word) words.emplace_back();
        in_word = true;
        if (escapes && i + 1 < text.size())
            words.back() += text[++i];
        else if (quote == '\0' && (c == '\'' || c == '"'))
            quote = c;
        else if (c == quote && quote != '\0')
            quote = '\0';
        else
            words.back() += c;
    }
    if (quote != '\0') refuse(option, text, "a command whose quotes are closed");
    return words;
}

}  // namespace

int read_integer(const std::string& option, std::string_view text, Interval range) {
    const auto value = number_of<int>(text);
    if (!value || *value < range.low || *value > range.high)
        refuse(option, text, described("a whole number", range));
    return *value;
}

double read_number(const std::string& option, std::string_view text, Interval range) {
    const auto value = number_of<double>(text);
    if (!value || !std::isfinite(*value) || !(*value >= range.low && *value <= range.high))
        refuse(option, text, described("a number", range));
    return *value;
}

std::size_t read_memory(const std::string& option, std::string_view text) {
    constexpr std::string_view units = "KMGT";
    constexpr double least = 32 << 20, most = double(std::size_t(1) << 60);
    std::string_view number = text;
    double unit = 1;
    if (!number.empty())
        if (const auto at = units.find(char(number.back() & ~0x20)); at != units.npos) {
            unit = std::pow(1024.0, double(at) + 1);
            number.remove_suffix(1);
        }
    const auto value = number_of<double>(number);
    if (!value || !(*value * unit >= least && *value * unit <= most))
        refuse(option, text, "a size of 32M or more, such as 512M or 2G");
    return std::size_t(*value * unit);
}

std::array<int, 2> read_size(const std::string& option, std::string_view text) {
    const auto cross = text.find_first_of("xX");
    const auto width = number_of<int>(text.substr(0, cross));
    const auto height =
        cross == std::string_view::npos ? std::nullopt : number_of<int>(text.substr(cross + 1));
    const auto fits = [](int side) { return side >= 1 && side <= longest_side; };
    if (!width || !height || !fits(*width) || !fits(*height))
        refuse(option, text,
               fmt::format("WIDTHxHEIGHT in pixels from 1 to {}, such as 800x600", longest_side));
    return {*width, *height};
}

Color read_color(const std::string& option, const std::string& text) {
    Color color(0);
    std::string_view rest = text;
    for (int i = 0; i < 3; ++i) {
        const auto comma = i < 2 ? rest.find(',') : rest.size();
        const auto value = comma == std::string_view::npos
                               ? std::nullopt
                               : number_of<float>(rest.substr(0, comma));
        if (!value || !std::isfinite(*value) || *value < 0)
            refuse(option, text, "R,G,B in linear numbers of 0 or more, such as 0.1,0.1,0.2");
        color[i] = *value;
        if (i < 2) rest.remove_prefix(comma + 1);
    }
    return color;
}

std::string environment_setting(const std::string& text) {
    if (text.starts_with('#')) return "environment.color=" + toml_string(text);
    if (text.find_first_of("./") != text.npos && text.find(',') == text.npos)
        return "environment.image=" + toml_string(text);
    if (text.find(',') == text.npos) return "environment.name=" + toml_string(text);
    const Color c = read_color("--environment", text);
    return fmt::format("environment.color=[{:.9},{:.9},{:.9}]", c.x, c.y, c.z);
}

PixelBox read_box(const std::string& option, const std::string& text) {
    std::array<int, 4> sides{};
    std::string_view rest = text;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto comma = i + 1 < sides.size() ? rest.find(',') : rest.size();
        const auto value =
            comma == std::string_view::npos ? std::nullopt : number_of<int>(rest.substr(0, comma));
        if (!value || *value < 0) refuse(option, text, box_form);
        sides[i] = *value;
        if (i + 1 < sides.size()) rest.remove_prefix(comma + 1);
    }
    const auto [x0, y0, x1, y1] = sides;
    if (x0 >= x1 || y0 >= y1) refuse(option, text, box_form);
    return {x0, y0, x1, y1};
}

std::pair<std::string, double> read_limit(const std::string& option, const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        refuse(option, text, "METRIC=NUMBER, such as bias=0.002");
    return {text.substr(0, equals),
            read_number(option, std::string_view(text).substr(equals + 1), {-1e9, 1e9})};
}

OtherRenderer read_renderer(const std::string& option, const std::string& text) {
    const auto equals = text.find('=');
    OtherRenderer result = {.name = text.substr(0, equals)};
    const auto plain = [](char c) {
        return is_letter_or_digit(c) || c == '-' || c == '_' || c == '.';
    };
    if (equals == std::string::npos || result.name.empty() || result.name.front() == '.' ||
        !std::ranges::all_of(result.name, plain))
        refuse(option, text,
               "NAME=COMMAND with a name of letters, digits, '.', '-' and '_', such as "
               "'Cycles=render.sh {pov} {out}'");
    result.words = split_words(option, text.substr(equals + 1));
    if (std::ranges::none_of(result.words, [](const std::string& word) {
            return word.find("{out") != std::string::npos;
        }))
        refuse(option, text, "a command with {out} where the picture's file name belongs");
    return result;
}

// TOML 1.0, section "String".
std::string toml_string(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (code < 0x20 || code == 0x7f)
            quoted += fmt::format("\\u{:04x}", code);
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string shell_command(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        if (is_plain(word)) {
            line += word;
            continue;
        }
        line += '\'';
        for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

std::size_t read_choice(const std::string& option, std::string_view text,
                        const std::vector<std::string>& words) {
    const auto found = std::find(words.begin(), words.end(), text);
    if (found != words.end()) return std::size_t(found - words.begin());
    if (words.size() == 1)
        throw Error(Failure::usage, option, fmt::format("'{}' is not {}", text, words[0]));
    const std::vector<std::string> others(words.begin(), words.end() - 1);
    throw Error(Failure::usage, option,
                fmt::format("'{}' is not {} or {}", text, fmt::join(others, ", "), words.back()));
}

}  // namespace penumbra::cli
