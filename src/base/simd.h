// Loops over arrays are compiled for several instruction sets; the best one is chosen at run time.
// Results are the same in all of them: no sums are reordered and no multiply-adds are fused.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define PENUMBRA_VECTORISED                                                                        \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default"), noinline))
#else
#define PENUMBRA_VECTORISED
#endif

/// Before a loop of which no turn depends on another.
#if defined(__clang__)
#define PENUMBRA_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define PENUMBRA_INDEPENDENT _Pragma("GCC ivdep")
#else
#define PENUMBRA_INDEPENDENT
#endif
