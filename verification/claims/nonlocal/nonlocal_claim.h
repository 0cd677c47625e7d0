#pragma once

#include <functional>
#include <string>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/spectrum.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Grid and rings of a nonlocal continuum.
struct NonlocalStencil
{
  std::string name; ///< in rows: "square grid, m = 2"
  lattice::Grid grid;
  double half_width = M_PI / 6.; ///< of the arcs of its rings [rad]
};

/// What the claim is checked for.
struct NonlocalOptions
{
  std::vector<NonlocalStencil> stencils; ///< each has the rows of homogeneous deformations, waves, length and cut
  unsigned int samples = 20;             ///< random F
  double breaking_stretch = 3.;          ///< lam_f [-]
  /// Changes of rings and of half-bonds by which tests plant faults; none by default.
  std::function<void(std::vector<lattice::Ring> &)> planted_rings = [](auto &) {};
  std::function<void(std::vector<lattice::HalfBond> &)> planted_bonds = [](auto &) {};
  double planted_tip = 0.; ///< added to the tip of the cut [m], as of a rule that finds another one
  PlantedBranches planted_branches = {};
};

/// Square and triangular grids of a lattice with spacing `d` [m] for m = 1.5, 2 and 3, bonds in all directions.
std::vector<NonlocalStencil> fixed_stencils(double d, lattice::Orientation orientation);

/// Claim `nonlocal`: the nonlocal continuum, bonds of the lattice's lengths in all directions on a grid, has the moduli
/// of the network law and the mean over rotations of the lattice, up to what its grid leaves; and converges to both
/// with the spacing h = d/m of the grid (theory-comparison.md, eqs. (H.25) to (H.28)).
///
/// Energies, stresses, waves and the energy of a cut are those of the simulator on a sheet with the stencil. Every rank
/// computes all of it.
output::Results nonlocal_claim(const bridge::Subject &subject, const NonlocalOptions &options);

} // namespace latcon::claims
