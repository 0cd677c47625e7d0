#pragma once

/// @file
/// Instruction sets that the kernels are compiled for, which google-highway chooses from. Those between SSSE3, AVX2 and
/// AVX-512 would gain nothing. Vectors of SVE have no size known to the compiler, so no struct can hold one; processors
/// with SVE use NEON.

/// Instruction sets left out, as google-highway names them.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
