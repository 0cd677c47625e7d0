#pragma once

#include <string>
#include <vector>

/// Instruction sets that the compiled loops of the lattice have copies for.
namespace benchmarks
{

/// Those that the kernel can be held to on this machine; none: it cannot.
inline std::vector<std::string> instruction_sets()
{
  return {};
}

/// Has the kernel use one of instruction_sets() from now on. @return whether there is one of that name
inline bool hold_to(const std::string &)
{
  return false;
}

/// The one in use.
inline std::string instruction_set()
{
  return __builtin_cpu_supports("avx512f") ? "x86-64-v4" : __builtin_cpu_supports("avx2") ? "x86-64-v3" : "x86-64";
}

} // namespace benchmarks
