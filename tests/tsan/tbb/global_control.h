// Stands in for TBB under ThreadSanitizer: see ../README.md.
#pragma once

#include "parallel_for.h"

namespace tbb {

class global_control {
  public:
    enum parameter { max_allowed_parallelism };

    global_control(parameter, std::size_t threads) : before_(stand_in::concurrency) {
        stand_in::concurrency = threads;
    }
    ~global_control() { stand_in::concurrency = before_; }
    global_control(const global_control&) = delete;
    global_control& operator=(const global_control&) = delete;

    static std::size_t active_value(parameter) { return stand_in::concurrency; }

  private:
    std::size_t before_;
};

}  // namespace tbb
