// The figures of a comparison as text.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/report.h"

#include <string>
#include <vector>

namespace penumbra::cli {

/// Verdict, a table of every metric with its limit, the worst pixel and the diagnosis.
std::string figures(const Case& result);

/// One line for each case and one with the totals.
std::string overview(const std::vector<Case>& cases);

/// The exit status that follows from a verdict other than error.
int verdict_status(Verdict verdict);

}  // namespace penumbra::cli
