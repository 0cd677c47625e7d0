#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "lattice/material.h"

namespace latcon::claims
{

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

} // namespace latcon::claims
