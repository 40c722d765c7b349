// How much memory reading, rendering and comparing may take.
//
// Files come from strangers, and a small one can describe more than any machine holds. Before
// memory is taken for what a file says, its size is held against a limit; beyond it there is an
// Error, and the system never has to end a process.
#pragma once

#include <cstddef>

namespace penumbra {

/// Sets the limit of this process, in bytes of memory that it uses, the caller's own included; 0
/// stands for the default. Of the whole process, and the one setting that is: memory has no other
/// owner. A POV-Ray that is run has the same limit for itself.
void set_memory_limit(std::size_t bytes);

/// The limit. Unless it was set: three quarters of what was free when it was first asked for, in
/// the machine and in the process's control groups.
std::size_t memory_limit();

/// Longest name that is kept of a file, in bytes; the rest is cut.
inline constexpr std::size_t max_name = 1024;

}  // namespace penumbra
