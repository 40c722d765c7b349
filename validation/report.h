// What the forms of the report share.
#pragma once

#include "penumbra/validation.h"

#include <cstddef>
#include <string>
#include <vector>

namespace penumbra {

/// The report as one offline HTML page.
std::string report_html(const std::vector<Case>& cases);

/// A loss and how often it occurs.
struct CountedLoss {
    Loss loss;
    std::size_t count = 1;
};

/// Equal losses are one, in the order of their first occurrence.
std::vector<CountedLoss> counted(const Losses& losses);

/// "flip 0.02 > 0.01; ssim 0.98 < 0.99": the limits that are not met.
std::string broken_limits(const Comparison& comparison);

}  // namespace penumbra
