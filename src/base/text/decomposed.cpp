#include "base/text/decomposed.h"

#include "base/text/decompositions.h"
#include "base/text/utf8.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace penumbra {

namespace {

using Code = std::uint32_t;

// The row of three whose first entry is the last one not above `code`; empty: there is none.
std::span<const char16_t> row_of(std::span<const char16_t> table, Code code) {
    std::size_t from = 0, to = table.size() / 3;
    while (from < to) {
        const std::size_t middle = (from + to) / 2;
        if (table[3 * middle] <= code)
            from = middle + 1;
        else
            to = middle;
    }
    return from == 0 ? std::span<const char16_t>() : table.subspan(3 * (from - 1), 3);
}

unsigned combining_class(Code code) {
    const auto run = row_of(combining_runs(), code);
    return run.empty() || code > run[1] ? 0 : run[2];
}

// Hangul syllables: the Unicode Standard, section 3.12, "Hangul Syllable Decomposition".
constexpr Code syllables = 0xac00, leads = 0x1100, vowels = 0x1161, tails = 0x11a7;
constexpr Code vowel_count = 21, tail_count = 28, syllable_count = 11172;

void append_parts(std::vector<Code>& codes, Code code) {
    if (code >= syllables && code < syllables + syllable_count) {
        const Code index = code - syllables, tail = index % tail_count;
        codes.push_back(leads + index / (vowel_count * tail_count));
        codes.push_back(vowels + index / tail_count % vowel_count);
        if (tail != 0) codes.push_back(tails + tail);
        return;
    }
    const auto pair = row_of(decomposition_pairs(), code);
    if (pair.empty() || pair[0] != code) {
        codes.push_back(code);
        return;
    }
    append_parts(codes, pair[1]);
    if (pair[2] != 0) append_parts(codes, pair[2]);
}

// Marks that do not touch one another may stand in any order; here that of their classes.
void order_marks(std::vector<Code>& codes) {
    const auto is_mark = [](Code code) { return combining_class(code) != 0; };
    for (auto at = codes.begin(); at != codes.end();) {
        const auto begin = std::find_if(at, codes.end(), is_mark);
        at = std::find_if_not(begin, codes.end(), is_mark);
        std::stable_sort(begin, at,
                         [](Code a, Code b) { return combining_class(a) < combining_class(b); });
    }
}

void flush(std::vector<Code>& codes, std::string& text) {
    order_marks(codes);
    for (const Code code : codes) append_utf8(text, code);
    codes.clear();
}

}  // namespace

std::string decomposed(std::string_view text) {
    if (is_ascii(text)) return std::string(text);
    std::string result;
    std::vector<Code> codes;
    while (!text.empty()) {
        Code code = 0;
        const std::size_t length = utf8_character(text, code);
        if (length == 0) {
            flush(codes, result);
            result += text.front();
        } else {
            append_parts(codes, code);
        }
        text.remove_prefix(std::max(length, std::size_t(1)));
    }
    flush(codes, result);
    return result;
}

}  // namespace penumbra
