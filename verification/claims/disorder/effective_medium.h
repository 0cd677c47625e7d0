#pragma once

#include <array>
#include <functional>

#include "lattice/disorder.h"
#include "lattice/material.h"

namespace latcon::claims
{

/// Mean of a function of the factor of a bond over its distribution, from the density and not from random numbers.
/// @param distribution not none
double mean_over(const lattice::Distribution &distribution, const std::function<double(double)> &function);

/// Effective medium of the bonds of a periodic, undeformed sheet (theory-comparison.md, eqs. (H.22)
/// and (H.23)): of each kind the
/// factor of the stiffness, and the share a of a bond in its own response.
struct EffectiveMedium
{
  std::array<double, lattice::n_bond_kinds> factor{}; ///< [-]; 0 for kinds that the material lacks
  std::array<double, lattice::n_bond_kinds> share{};  ///< [-]
};

/// Solves the equations of the effective medium, with the sum over all wave vectors of the sheet.
/// @param sheet periodic in both directions
EffectiveMedium effective_medium(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                 const lattice::Distribution &distribution);

} // namespace latcon::claims
