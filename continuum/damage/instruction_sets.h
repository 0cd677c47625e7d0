#pragma once

/// Attribute that compiles a function for several instruction sets, of which the loader picks one. The build does not
/// contract to fused multiply-add, so that all give the same bits.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__OPTIMIZE__) &&                        \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define LATCON_INSTRUCTION_SETS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LATCON_INSTRUCTION_SETS
#endif
