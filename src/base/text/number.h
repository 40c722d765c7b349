// Numbers for people.
#pragma once

#include <optional>
#include <string>

namespace penumbra {

/// `value` in six significant digits, or in as many more as it takes to be on the side of 1, and of
/// `limit`, that it is on: what is not quite 1 never looks like 1. Of `value` only the magnitude is
/// held against the limit. "nan" for NaN.
std::string number_text(double value, std::optional<double> limit = {});

/// A limit as it was given: six significant digits, or as many as it has.
std::string limit_text(double limit);

}  // namespace penumbra
