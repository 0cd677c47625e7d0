#pragma once

#include <string>
#include <vector>

#include "lattice/material.h"

namespace latcon::output
{

/// Returns the names of the mechanisms of memories in the columns of energy.csv, in the order of
/// lattice::Simulation::mechanism_energies() and of bridge::homogenised_memory(): "nearest_branch_1", ...
inline std::vector<std::string> mechanism_names(const lattice::Material &material)
{
  std::vector<std::string> names;
  const auto add = [&](const std::string &shell, const lattice::Shell &bonds)
  {
    if (std::holds_alternative<lattice::PlasticMemory>(bonds.memory))
      names.push_back(shell + "_plastic");
    else
      for (std::size_t m = 1; m <= lattice::n_mechanisms(bonds.memory); ++m)
        names.push_back(shell + "_branch_" + std::to_string(m));
  };
  add("nearest", material.nearest);
  if (material.next_nearest)
    add("next_nearest", *material.next_nearest);
  if (material.third_nearest)
    add("third_nearest", *material.third_nearest);
  return names;
}

} // namespace latcon::output
