// How much memory reading, rendering and comparing may take.
//
// Files come from strangers, and a small one can describe more than any machine holds. Before
// memory is taken for what a file says, its size is held against a limit, if one is set; beyond it
// there is an Error, and the system never has to end a process.
#pragma once

#include <cstddef>

namespace penumbra {

/// Sets the limit of this process, in bytes of memory that it uses, the caller's own included; 0:
/// none, which is the default. Of the whole process, and the one setting that is: memory has no
/// other owner. A POV-Ray that is run has the same limit for itself. Without a limit what does not
/// fit ends as std::bad_alloc, or by the system's hand: to read files by strangers, set one.
void set_memory_limit(std::size_t bytes);

/// The limit; 0: none.
std::size_t memory_limit();

/// Bytes that are free now, in the machine, in the process's control groups and by its resource
/// limits; 0 where the system does not tell. The program's own limit is three quarters of it.
std::size_t free_memory();

/// Longest name that is kept of a file, in bytes; the rest is cut.
inline constexpr std::size_t max_name = 1024;

}  // namespace penumbra
