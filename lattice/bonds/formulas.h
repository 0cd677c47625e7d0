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

/// User-defined law.
inline double force_of_each(const CustomBond &law, double stretch)
{
  return law.force(stretch);
}
/// User-defined memory. Absent bonds have no length.
inline double advance_each(const CustomMemory::Step &step, double before, double now, double *variables,
                           double &dissipation)
{
  dissipation = 0.;
  if (!(now > 0.))
    return 0.;
  const double earlier = step.dissipates_energy ? step.law->dissipation(before, variables) : 0.;
  const double overstress = step.law->advance(step.duration, before, now, variables);
  dissipation = step.law->dissipation(now, variables) - earlier;
  return overstress;
}

#include "lattice/bonds/formulas.inc"

} // namespace latcon::lattice::formulas
