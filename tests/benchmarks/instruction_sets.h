#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <hwy/targets.h>

#include "lattice/row_kernels.h"

/// Instruction sets that the hot loops of the lattice have copies for.
namespace benchmarks
{

/// Has the loops use an instruction set from here on. @return whether they have a copy for it that this machine can run
inline bool hold_to(std::int64_t target)
{
  hwy::SetSupportedTargetsForTest(target);
  // Without a copy they fall back to another.
  return hwy::TargetName(target) == std::string(lattice::kernels::instruction_set());
}

/// Has the loops use all that there is.
inline void release()
{
  hwy::SetSupportedTargetsForTest(0);
}

/// Those that the loops can be held to on this machine, best first, as numbers of google-highway.
inline std::vector<std::int64_t> instruction_sets()
{
  release();
  std::vector<std::int64_t> found;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (hold_to(target))
      found.push_back(target);
  release();
  return found;
}

/// The same by a name, AVX3 or AVX2 for instance. @return whether there is one of that name
inline bool hold_to(const std::string &name)
{
  for (const std::int64_t target : instruction_sets())
    if (name == hwy::TargetName(target))
      return hold_to(target);
  return false;
}

} // namespace benchmarks
