// What the forms of the report share.
#pragma once

#include "penumbra/compare.h"
#include "penumbra/report.h"

#include <string>
#include <vector>

namespace penumbra {

/// The page of one case: one offline HTML file. `index_link` leads back to the list of all cases;
/// empty: there is none.
std::string case_page(const Case& one, const std::string& index_link);

/// The list of all cases, the worst first, with links to their pages.
std::string index_page(const std::vector<Case>& cases);

/// "flip 0.02 > 0.01; ssim 0.98 < 0.99": the limits that are not met.
std::string broken_limits(const Comparison& comparison);

}  // namespace penumbra
