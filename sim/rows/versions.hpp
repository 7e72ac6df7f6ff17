#pragma once

// A kernel is compiled once per level of the x86-64 instruction set, and the machine picks its own when the
// program starts. Contraction into fused multiply-adds is off everywhere (CMakeLists.txt) and no kernel uses
// an approximate instruction, so that all versions give the same bits.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define UNRAVEL_VERSIONS __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define UNRAVEL_VERSIONS
#endif

// What a kernel calls has to be part of it.
#define UNRAVEL_INLINE inline __attribute__((always_inline))
