// Independent pieces of work with all processors.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
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

/// Calls work(first, last) for runs of 0 ... count that are worth a task each.
template <class Work>
void for_each_block(std::size_t count, const Work& work) {
    constexpr std::size_t block = std::size_t(1) << 15;
    for_each_in_parallel((count + block - 1) / block,
                         [&](std::size_t i) { work(i * block, std::min(count, (i + 1) * block)); });
}

}  // namespace penumbra
