// Independent pieces of work with all processors.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <exception>
#include <vector>

namespace penumbra {

/// Calls work(0) to work(count - 1), at the same time where there are processors. Throws what the
/// first of them throws, in the order of their numbers, whichever fails first.
template <class Work>
void for_each_in_parallel(std::size_t count, const Work& work) {
    if (count == 1) return work(0);
    std::vector<std::exception_ptr> errors(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        try {
            work(i);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

}  // namespace penumbra
