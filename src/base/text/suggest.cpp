#include "base/text/suggest.h"

#include "base/text/text.h"

#include <algorithm>

namespace penumbra {

namespace {

std::string listed(const std::vector<std::string>& words) {
    constexpr std::size_t most = 20;
    std::string text;
    for (std::size_t i = 0; i < std::min(words.size(), most); ++i)
        text += (i > 0 ? ", " : "") + printable(words[i]);
    return words.size() > most ? text + ", ..." : text;
}

}  // namespace

// Optimal string alignment distance: Damerau 1964, "A technique for computer detection and
// correction of spelling errors", restricted to swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before, above, row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before = std::move(above);
        above = std::move(row);
        row.assign(b.size() + 1, i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower_case(a[i - 1]) == lower_case(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower_case(a[i - 1]) == lower_case(b[j - 2]) &&
                lower_case(a[i - 2]) == lower_case(b[j - 1]))
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row.back();
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    constexpr std::size_t longest = 100;  // of a word that somebody mistyped
    const std::string* best = nullptr;
    std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        if (word.size() > longest || candidate.size() > longest) continue;
        const std::size_t distance = edit_distance(word, candidate);
        if (distance >= least) continue;
        least = distance;
        best = &candidate;
    }
    return best == nullptr ? "" : " (did you mean '" + printable(*best) + "'?)";
}

std::string hint(std::string_view word, const std::vector<std::string>& candidates,
                 std::string_view what) {
    if (candidates.empty()) return "";
    const std::string meant = did_you_mean(word, candidates);
    return meant.empty() ? " (" + std::string(what) + ": " + listed(candidates) + ")" : meant;
}

}  // namespace penumbra
