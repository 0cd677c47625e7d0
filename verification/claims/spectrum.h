/// Maxwell branches of the lattices on which claims about memories run.
#pragma once

#include <functional>
#include <stdexcept>
#include <variant>
#include <vector>

#include "lattice/state.h"

namespace latcon::claims
{

/// Returns the relaxation times of the branches of all shells [s].
inline std::vector<double> relaxation_times(const lattice::Material &material)
{
  std::vector<double> times;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      if (const auto *memory = std::get_if<lattice::MaxwellMemory>(&shell->memory))
        for (const lattice::MaxwellMemory::Branch &branch : memory->branches())
          times.push_back(branch.relaxation_time);
  return times;
}

/// Returns whether the bonds of some shell have Maxwell branches, of which each has one at least.
inline bool has_branches(const lattice::Material &material)
{
  return !relaxation_times(material).empty();
}

/// Gives all bonds branches with these moduli over the stiffness of a bond at rest [-], > 0, and these relaxation times
/// [s], > 0: one of each per branch, 1 to lattice::max_history_variables of them.
/// @throws std::invalid_argument for other numbers or values
inline lattice::Material with_branches(lattice::Material material, const std::vector<double> &ratios,
                                       const std::vector<double> &relaxation_times)
{
  if (ratios.size() != relaxation_times.size())
    throw std::invalid_argument("branches need as many relaxation times as moduli");
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (lattice::Shell *shell = material.in_shell(number))
    {
      std::vector<lattice::MaxwellMemory::Branch> branches;
      for (std::size_t i = 0; i < ratios.size(); ++i)
        branches.push_back({ratios[i] * lattice::stiffness(shell->law, 1.), relaxation_times[i]});
      shell->memory = lattice::MaxwellMemory(branches);
    }
  return material;
}

/// Returns the held sheet, strained suddenly from I to F: memories are those of the unloaded sheet at rest.
inline lattice::State suddenly_strained(const lattice::RowPartition &rows, const lattice::Material &material,
                                        const Eigen::Matrix2d &F)
{
  lattice::State unloaded =
    lattice::homogeneous_state(rows, material, Eigen::Matrix2d::Identity(), lattice::Edges::held);
  lattice::relax_memory(unloaded, rows, material);
  lattice::State state = lattice::homogeneous_state(rows, material, F, lattice::Edges::held);
  state.history = std::move(unloaded.history);
  return state;
}

/// Returns a material with other branches in the lattice that runs; tests plant faults with it.
using PlantedBranches = std::function<lattice::Material(const lattice::Material &)>;

} // namespace latcon::claims
