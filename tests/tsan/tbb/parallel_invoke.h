// Stands in for TBB under ThreadSanitizer: see ../README.md.
#pragma once

#include "parallel_for.h"

namespace tbb {

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
    stand_in::run(2, [&](std::size_t i) { i == 0 ? first() : second(); });
}

}  // namespace tbb
