#pragma once

// Vector types of the innermost loops. Sums run over four lanes in a fixed order, and the build does not contract to
// fused multiply-add, so the bits do not depend on the instruction set.

namespace latcon::continuum
{
/// Four doubles at once.
typedef double Lanes __attribute__((vector_size(32)));
/// Four floats, to be converted to doubles.
typedef float SingleLanes __attribute__((vector_size(16)));

constexpr unsigned int n_lanes = 4; ///< number of entries of both types

/// Returns the smallest multiple of the number of lanes that is at least n.
constexpr unsigned int padded_size(const unsigned int n)
{
  return (n + n_lanes - 1) / n_lanes * n_lanes;
}
} // namespace latcon::continuum

/// Attribute that compiles a function also for AVX2; the program chooses at startup.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define LATCON_CLONES __attribute__((target_clones("default", "avx2")))
#else
#define LATCON_CLONES
#endif
