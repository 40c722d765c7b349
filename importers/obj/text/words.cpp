#include "importers/obj/text/words.h"

#include "base/text/ascii.h"
#include "base/text/text.h"
#include "importers/obj/text/tally.h"

#include <fmt/format.h>

#include <algorithm>

namespace penumbra::obj {

namespace {

constexpr std::string_view blanks = " \t\v\f";

constexpr bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\f' && c != '\n'); }

// Takes [+-] off the front of `text`.
void skip_sign(std::string_view& text) {
    if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
}

// Takes digits off the front of `text`; returns how many there were.
std::size_t skip_digits(std::string_view& text) {
    std::size_t count = 0;
    while (count < text.size() && is_digit(text[count])) ++count;
    text.remove_prefix(count);
    return count;
}

// A word that C libraries print for a value that is no number: nan, -nan(ind), inf, 1.#IND.
bool names_no_number(std::string_view word) {
    skip_sign(word);
    const std::string start = lower_case(word.substr(0, 3));
    return start == "nan" || start == "inf" || start == "1.#";
}

}  // namespace

std::string place_of(const std::string& file, Index line) {
    return line ? fmt::format("{}:{}", file, line) : file;
}

std::string_view trim(std::string_view text) { return trimmed(text, blanks); }

std::string_view next_word(std::string_view& text) {
    std::size_t first = 0;
    while (first < text.size() && is_blank(text[first])) ++first;
    std::size_t end = first;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const std::string_view word = text.substr(first, end - first);
    text.remove_prefix(end);
    return word;
}

std::string_view without_comment(std::string_view text) {
    std::size_t at = text.find('#');
    while (at < text.size() && at > 0 && text[at - 1] == '.') at = text.find('#', at + 1);
    return text.substr(0, at);
}

std::string_view name_without_comment(std::string_view text) {
    for (std::size_t at = text.find('#'); at < text.size(); at = text.find('#', at + 1)) {
        const auto blank = [&](std::size_t i) { return i >= text.size() || is_blank(text[i]); };
        if (at > 0 && blank(at - 1) && blank(at + 1)) return trim(text.substr(0, at));
    }
    return trim(text);
}

// [+-] (digits [. digits*] | . digits) [eE [+-] digits]
Word kind_of(std::string_view word) {
    std::string_view rest = word;
    skip_sign(rest);
    std::size_t mantissa = skip_digits(rest);
    if (rest.starts_with('.')) {
        rest.remove_prefix(1);
        mantissa += skip_digits(rest);
    }
    std::size_t exponent = 1;
    if (mantissa > 0 && (rest.starts_with('e') || rest.starts_with('E'))) {
        rest.remove_prefix(1);
        skip_sign(rest);
        exponent = skip_digits(rest);
    }
    if (mantissa == 0 || exponent == 0 || !rest.empty())
        return names_no_number(word) ? Word::not_finite : Word::other;
    return exponent < 9 ? Word::number : Word::not_finite;  // tinyobjloader reads more as zero
}

}  // namespace penumbra::obj
