#pragma once

#include <array>
#include <vector>

#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"
#include "verification/claims/spectrum.h"

namespace latcon::claims
{

/// Size of the claim.
struct RelaxationOptions
{
  /// Time steps of each integrator of the lattice; fewer if three of the longest relaxation times pass before.
  std::size_t max_steps = 2000;
  PlantedBranches planted = [](const lattice::Material &material) { return material; }; ///< for tests
};

/// Claim `relaxation`: a sheet that is strained suddenly and then held relaxes along the closed form of its branches
/// (theory.md, eq. (L.31)), with both time integrators: first Piola stress, measured as the force on the edge of the
/// sheet; energy stored in each branch, energy dissipated by each, and the energy balance. Finite elements of the
/// Cauchy-Born continuum relax along the same closed form.
///
/// Without branches of its own, a lattice is given three per shell.
ClaimOutcome relaxation_claim(const bridge::Subject &subject, const RelaxationOptions &options);

/// One branch of one shell in a sheet strained suddenly (theory.md, eq. (L.31)).
struct BranchTheory
{
  double relaxation_time; ///< [s]
  double stored;          ///< at the start, in all bonds [J/m]
  Eigen::Matrix2d stress; ///< first Piola, at the start [Pa]
};

/// Returns the branches of a sheet strained from I to F, those of nearest-neighbour bonds first: q_i = E_i (lam - 1),
/// energies and stresses by sums over bonds. @param n_bonds of each kind, fractions included
std::vector<BranchTheory> relaxing_branches(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                            const std::array<double, lattice::n_bond_kinds> &n_bonds,
                                            const Eigen::Matrix2d &F);

/// Adds rows that compare a held sheet of finite elements, strained suddenly from I to F, with the closed form of its
/// branches (theory.md, eq. (L.31)), summed over the bonds of a site: first Piola stress, measured as the moment of the
/// nodal reactions, energies of each branch, and their balance. Every rank computes all of it.
/// @param sheet only its bonds matter
/// @param material of the closed form, with Maxwell branches @param planted of the finite elements
/// @param time_step [s] @param n_steps 2 or more
/// @throws what continuum::DynamicSolver throws
void add_held_elements(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                       const lattice::Material &material, const lattice::Material &planted, const Eigen::Matrix2d &F,
                       double time_step, std::size_t n_steps, ClaimOutcome &outcome);

} // namespace latcon::claims
