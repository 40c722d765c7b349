// Calls into the code of a host program.
#pragma once

#include <tbb/task_arena.h>

namespace penumbra {

/// Calls a function of somebody else's from within a task. Should it wait for tasks of its own, the
/// thread takes none of ours meanwhile, which could wait for what this one holds.
template <class Call>
void call_isolated(const Call& call) {
    tbb::this_task_arena::isolate(call);
}

}  // namespace penumbra
