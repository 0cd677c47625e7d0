#pragma once

#include <variant>

#include "lattice/bonds/formulas.h"

/// @file
/// Bond laws: energy, force and stiffness as functions of the stretch alone. What a bond adds that depends on its past
/// is its memory (bond_memory.h).
///
/// A bond of rest length l and cross-section A0 stores A0 l psi(lam), lam = |x_j - x_i| / l > 0 being its stretch, and
/// pulls with the axial force A0 psi'(lam), tension positive. A law gives psi, psi' and psi'' in Pa. laws.h has a
/// struct with its constants, energy, stiffness and limits; formulas.inc has its force for any type of number.
namespace latcon::lattice
{

/// Bond law of one shell.
using BondLaw = std::variant<MooneyRivlinBond, LinearBond, CustomBond>;

/// psi [Pa].
inline double energy(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.energy(stretch); }, law);
}
/// psi' [Pa].
inline double force(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return formulas::force(l, stretch, 1. / stretch); }, law);
}
/// psi'' [Pa].
inline double stiffness(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return l.stiffness(stretch); }, law);
}
/// Largest psi'' [Pa] of all stretches from `smallest_stretch` [-] on that a bond reaches.
inline double largest_stiffness(const BondLaw &law, double smallest_stretch)
{
  return std::visit([smallest_stretch](const auto &l) { return l.largest_stiffness(smallest_stretch); }, law);
}
/// Returns whether short bonds may require divided time steps; false for laws as stiff at any stretch.
inline bool stiffens_when_short(const BondLaw &law)
{
  return std::visit([](const auto &l) { return l.stiffens_when_short; }, law);
}

} // namespace latcon::lattice
