#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

/// Sheets whose motion the benchmarks time: stretched, a little disturbed, all edges held, and no bond near breaking.
namespace benchmarks
{

/// Material of the sheet, and quantities monitored in every step.
enum class Work
{
  everything,     ///< Mooney-Rivlin bonds to twelve neighbours, dashpots, breaking and toughening watched
  nearest,        ///< the same with six neighbours
  one_branch,     ///< everything, and one Maxwell branch per bond
  three_branches, ///< everything, and three Maxwell branches per bond
  linear          ///< linear bonds to twelve neighbours, and nothing else
};

/// @throws std::invalid_argument for another name
inline Work work_of(const std::string &name)
{
  static const std::map<std::string, Work> names{{"everything", Work::everything},
                                                 {"nearest", Work::nearest},
                                                 {"one_branch", Work::one_branch},
                                                 {"three_branches", Work::three_branches},
                                                 {"linear", Work::linear}};
  const auto found = names.find(name);
  if (found == names.end())
    throw std::invalid_argument("\"" + name + "\" is none of everything, nearest, one_branch, three_branches, linear");
  return found->second;
}

inline latcon::lattice::Material material(Work work)
{
  if (work == Work::nearest)
    return sheets::nearest_only();
  if (work == Work::one_branch || work == Work::three_branches)
  {
    latcon::lattice::Material bonds = sheets::rubber();
    std::vector<latcon::lattice::MaxwellMemory::Branch> branches{{2e5, 1e-4}};
    if (work == Work::three_branches)
      branches.insert(branches.end(), {{2e5, 1e-3}, {2e5, 1e-2}});
    bonds.nearest.memory = bonds.next_nearest->memory = latcon::lattice::MaxwellMemory(branches);
    return bonds;
  }
  if (work == Work::everything)
    return sheets::rubber();
  const latcon::lattice::LinearBond bond{6e5};
  return {944., {bond, 2. / 3., 0.}, latcon::lattice::Shell{bond, 2. / 3., 0.}};
}

/// A square sheet that is ready to move.
struct Motion
{
  /// @param n_sites about [-]; rounded to whole rows and columns
  /// @param stages of Runge-Kutta-Chebyshev, in steps about as long as those of a crack; 0: velocity Verlet
  Motion(Work work, double n_sites, unsigned int stages = 0)
    : sheet(sheets::square(std::sqrt(n_sites * std::sqrt(0.75)))), bonds(material(work)),
      // Stable while no bond contracts to half of its length, and none does.
      simulation(sheet, bonds, loaded(work),
                 stages > 0 ? latcon::lattice::TimeStepping(3e-6, stages)
                            : latcon::lattice::TimeStepping(0.5 * time_step_limits(sheet, bonds, 0.5).combined),
                 rules(work))
  {
  }

  latcon::lattice::TriangularLattice sheet;
  latcon::lattice::Material bonds;
  latcon::lattice::Simulation simulation;

private:
  static Eigen::Matrix2d deformation(Work work)
  {
    return work == Work::linear ? sheets::stretched(1.05, 1.1) : sheets::stretched(2.3, 2.8);
  }

  latcon::lattice::State loaded(Work work) const
  {
    latcon::lattice::State state = homogeneous_state(sheet, bonds, deformation(work), latcon::lattice::Edges::held);
    add_noise(state, sheet, 0.05 * sheets::spacing, 1);
    return state;
  }

  std::optional<latcon::lattice::Fracture> rules(Work work) const
  {
    if (work == Work::linear)
      return std::nullopt;
    return latcon::lattice::Fracture(sheet, bonds, breaking_stretch, latcon::lattice::Toughening{3., 0.5},
                                     deformation(work));
  }

  static constexpr double breaking_stretch = 5.;
};

} // namespace benchmarks
