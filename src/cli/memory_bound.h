// What --max-memory means for the program.
#pragma once

#include <cstddef>
#include <string>

namespace penumbra::cli {

/// Sets the library's limit; 0: three quarters of what is free. Beyond it the system refuses memory
/// too, so that what the library does not foresee ends as std::bad_alloc and not as the end of the
/// process.
void bound_memory(std::size_t limit);

/// What to say of std::bad_alloc.
std::string out_of_memory();

}  // namespace penumbra::cli
