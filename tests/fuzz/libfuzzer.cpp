// libFuzzer's entry point to the target PENUMBRA_FUZZ_TARGET.
#include "fuzz.h"

#include <tbb/global_control.h>

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // With one thread the same input takes the same way every time.
    static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    static const fuzz::Target* const target = fuzz::target_named(PENUMBRA_FUZZ_TARGET);
    fuzz::start_memory_count();
    target->run({reinterpret_cast<const char*>(data), size});
    return 0;
}
