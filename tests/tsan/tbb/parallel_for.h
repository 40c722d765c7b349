// Stands in for TBB under ThreadSanitizer: see ../README.md.
#pragma once

#include "blocked_range.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tbb {

struct simple_partitioner {};

namespace stand_in {

/// How many threads this one may use for a loop; those of a loop use none for an inner one.
inline thread_local std::size_t concurrency = 4;

/// Calls work(0) to work(count - 1) with several threads, each taking the next number.
template <class Work>
void run(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next = 0;
    std::mutex one_at_a_time;
    std::exception_ptr error;
    const auto turn = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        } catch (...) {
            next = count;
            const std::lock_guard lock(one_at_a_time);
            if (!error) error = std::current_exception();
        }
    };
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min(count, concurrency); ++i)
        helpers.emplace_back([&] {
            concurrency = 1;
            turn();
        });
    turn();
    helpers.clear();
    if (error) std::rethrow_exception(error);
}

}  // namespace stand_in

template <class Index, class Work>
void parallel_for(Index first, Index last, const Work& work) {
    if (first < last)
        stand_in::run(std::size_t(last - first),
                      [&](std::size_t i) { work(Index(first + Index(i))); });
}

template <class Value, class Work>
void parallel_for(const blocked_range<Value>& range, const Work& work, simple_partitioner = {}) {
    const std::size_t grain = range.grainsize(), count = std::size_t(range.end() - range.begin());
    stand_in::run((count + grain - 1) / grain, [&](std::size_t i) {
        const Value begin = range.begin() + Value(i * grain);
        work(
            blocked_range<Value>(begin, std::min(Value(begin + Value(grain)), range.end()), grain));
    });
}

}  // namespace tbb
