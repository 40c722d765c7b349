#include "cli/memory_bound.h"

#include "base/memory.h"

#include "penumbra/limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <thread>

namespace penumbra::cli {
namespace {

// A sanitizer maps far more than the program uses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
constexpr bool sanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool sanitized = false;
#endif

}  // namespace

void bound_memory(std::size_t limit) {
    if (limit == 0) limit = free_memory() / 4 * 3;
    set_memory_limit(limit);
    if (sanitized || limit == 0) return;
    // RLIMIT_DATA counts what is mapped and not what is used: stacks and pools are larger than they
    // will ever be filled.
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t margin = (std::size_t(512) + 32 * threads) << 20;
    rlimit bound{};
    if (::getrlimit(RLIMIT_DATA, &bound) != 0 || limit > RLIM_INFINITY - margin - limit / 4) return;
    bound.rlim_cur = std::min<rlim_t>(limit + limit / 4 + margin, bound.rlim_max);
    ::setrlimit(RLIMIT_DATA, &bound);
}

std::string out_of_memory() {
    if (memory_limit() == 0) return "not enough memory";
    return fmt::format("not enough memory: {} may be used (raise it with --max-memory)",
                       memory_text(memory_limit()));
}

}  // namespace penumbra::cli
