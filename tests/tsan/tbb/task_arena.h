// Stands in for TBB under ThreadSanitizer: see ../README.md.
#pragma once

#include "parallel_for.h"

namespace tbb {

namespace this_task_arena {

inline int max_concurrency() { return int(stand_in::concurrency); }

// Threads of the stand-in take no tasks while they wait.
template <class Work>
auto isolate(const Work& work) {
    return work();
}

}  // namespace this_task_arena

class task_arena {
  public:
    static constexpr int automatic = -1;

    explicit task_arena(int threads = automatic) : threads_(threads) {}

    template <class Work>
    auto execute(const Work& work) const {
        struct Restore {
            std::size_t before = stand_in::concurrency;
            ~Restore() { stand_in::concurrency = before; }
        } const restore;
        if (threads_ != automatic) stand_in::concurrency = std::size_t(threads_);
        return work();
    }

  private:
    int threads_;
};

}  // namespace tbb
