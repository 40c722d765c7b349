// A mistyped word -> what was probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

/// Number of inserted, deleted, changed or swapped neighbouring characters that turn `a` into `b`;
/// upper and lower case count as equal.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// " (did you mean 'radius'?)" when a candidate is near `word`, else "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// The same; else " (<what>: a, b, c)" with all candidates (the first few of many); "" when there
/// are none.
std::string hint(std::string_view word, const std::vector<std::string>& candidates,
                 std::string_view what);

}  // namespace penumbra
