// What environment variables say, before options override it.
#pragma once

#include "cli/options/arguments.h"

namespace penumbra::cli {

/// PENUMBRA_THREADS and PENUMBRA_MAX_MEMORY. Throws Error (usage).
void apply_environment(Arguments& arguments);

}  // namespace penumbra::cli
