#pragma once

#include <cmath>

#include "lattice/bonds/laws.h"
#include "lattice/bonds/memories.h"

/// Formulas of bonds for one double.
namespace latcon::lattice::formulas
{

/// Magnitude beyond a limit > 0.
inline double excess(double value, double limit)
{
  const double beyond = std::abs(value) - limit;
  return beyond > 0. ? beyond : 0.;
}
/// The value within a limit > 0.
inline double clamped(double value, double limit)
{
  return value > limit ? limit : value < -limit ? -limit : value;
}

/// User-defined law. Absent bonds have no length.
inline double force(const CustomBond &bond, double stretch, double /*inverse*/)
{
  return stretch > 0. ? bond.law()->force(stretch) : 0.;
}
/// User-defined memory.
inline double advance(const CustomMemory &memory, std::size_t /*n*/, double before, double now, double *variables,
                      double *dissipation)
{
  *dissipation = 0.;
  if (!(now > 0.))
    return 0.;
  const double earlier = memory.dissipates_energy ? memory.law().dissipation(before, variables) : 0.;
  const double overstress = memory.law().advance(memory.duration(), before, now, variables);
  *dissipation = memory.law().dissipation(now, variables) - earlier;
  return overstress;
}

#include "lattice/bonds/formulas.inc"

} // namespace latcon::lattice::formulas

namespace latcon::lattice
{

/// psi' [Pa].
inline double force(const BondLaw &law, double stretch)
{
  return std::visit([stretch](const auto &l) { return formulas::force(l, stretch, 1. / stretch); }, law);
}
/// Overstress of a bond after an update of its variables by the formula of its memory [Pa].
/// @param dissipation of each mechanism, see memories.h
inline double advance(const BondMemory &memory, double before, double now, double *variables, double *dissipation)
{
  return std::visit(
    [&](const auto &m) { return formulas::advance(m, m.n_variables, before, now, variables, dissipation); }, memory);
}

} // namespace latcon::lattice
