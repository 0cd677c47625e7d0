#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "continuum/constitution.h"
#include "verification/bridge/equivalent_sheet.h"
#include "verification/claims/prestretch/cut_lattice.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Mesh and refinement of the finite element sheet.
struct CutMesh
{
  unsigned int degree = 3;
  unsigned int refinements = 0; ///< of the whole coarse mesh; the cells around a hole are refined once more
  unsigned int cycles = 1;      ///< of refinement where the error seems largest, each followed by an equilibrium
  double fraction = 0.3;        ///< of the cells, in each cycle [-]
};

/// Differences between a lattice and a continuum of the same sheet, all relative [-]. Positive where the lattice
/// has more, if they have a sign. Energy and reaction are compared as theory-comparison.md, eq. (H.12), has them.
struct CutErrors
{
  double displacement = unknown;     ///< rms over the sites with all their bonds, over |F - I| times the size of the cut
  double displacement_all = unknown; ///< rms over all free sites: at a rim, one that few bonds hold is far off by itself
  double displacement_max = unknown; ///< largest of all
  double stress = unknown;           ///< first Piola, rms over the sites with all their bonds, over the rms of the continuum's
  double cauchy_stress = unknown;    ///< likewise
  double stress_scale = unknown;     ///< of all these stresses at once: sum P_lattice : P / sum P : P - 1
  double energy = unknown;           ///< total
  double reaction = unknown; ///< force on the right edge along x and on the top edge along y, as a vector, along the continuum's
  double reaction_vector = unknown; ///< length of the difference of both
  double shape = unknown;           ///< opening of the hole along x and y, or of the mouth of the notch, likewise as a vector
  double fem = unknown;             ///< change of the displacement in the last cycle, as `displacement`
  double unknowns = unknown;
};

/// Equilibrium of the continuum at the sites of a lattice, in their order.
struct CutSolution
{
  CutErrors errors;               ///< against the lattice
  std::vector<Eigen::Vector2d> u; ///< displacement [m]
  std::vector<Eigen::Matrix2d> P; ///< first Piola stress [Pa]
  Eigen::Vector2d opening;        ///< of the cut [m], as in CutErrors::shape
};

/// Returns the differences between two continua, >= 0, in displacement, stress, scale of stresses, energy, reaction and
/// shape. @param a, b whose errors are against `lattice`
CutErrors distance(const CutLattice &lattice, const CutSolution &a, const CutSolution &b);

/// Calls `compute`. @return why there is no equilibrium, the message of a solver; empty if there is one
std::string no_equilibrium(const std::function<void()> &compute);

/// Solves the finite element sheet of a law and compares it with a lattice; none without an equilibrium, with the
/// reason in `failure`. Collective.
std::optional<CutSolution> compare(const CutLattice &lattice, const bridge::EquivalentSheet &domain,
                                   const continuum::Constitution &law, const CutMesh &mesh, std::string &failure);

} // namespace latcon::claims
