#include "cli/options/environment.h"

#include "cli/options/values.h"

#include <cstdlib>

namespace penumbra::cli {
namespace {

// Calls `apply` with the value of a variable that has one.
template <class Apply>
void with_variable(const char* name, Apply apply) {
    if (const char* const text = std::getenv(name); text != nullptr && *text != 0) apply(text);
}

}  // namespace

void apply_environment(Arguments& arguments) {
    with_variable("PENUMBRA_THREADS", [&](const char* text) {
        arguments.threads = read_integer("PENUMBRA_THREADS", text, {0, 1024});
    });
    with_variable("PENUMBRA_MAX_MEMORY", [&](const char* text) {
        arguments.max_memory = read_memory("PENUMBRA_MAX_MEMORY", text);
    });
}

}  // namespace penumbra::cli
