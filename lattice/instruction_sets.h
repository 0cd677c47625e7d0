#pragma once

/// @file
/// One copy of a loop per instruction set, chosen at run time. Without contraction to fused multiply-add all copies
/// round alike; the sanitizers cannot run before such a choice is made.
#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)
#define LATCON_PER_INSTRUCTION_SET
#else
#define LATCON_PER_INSTRUCTION_SET __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#endif
