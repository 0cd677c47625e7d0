#include "lattice/contact.h"
#include "verification/input/case.h"

namespace latcon::input
{

lattice::ContactLaw Case::contact_law() const
{
  return lattice::contact_like_nearest_bond(sheet(), material(), contact_distance * spacing, contact_stiffness,
                                            contact_viscosity);
}

double Case::chebyshev_step(const bool breaks) const
{
  if (breaks && has_contact)
    return safety_factor * lattice::chebyshev_step(sheet(), material(), smallest_chebyshev_stretch, contact_law());
  return safety_factor * lattice::chebyshev_step(sheet(), material(), smallest_chebyshev_stretch);
}

lattice::TimeStepping Case::time_stepping(const bool breaks) const
{
  const lattice::TimeStepLimits limits = time_step_limits(breaks);
  if (integrator == Integrator::velocity_verlet)
    return time_step ? *time_step : safety_factor * limits.combined;
  const double step = time_step ? *time_step : chebyshev_step(breaks);
  if (time_step && stages > 0)
    return {step, stages};
  return lattice::chebyshev_time_stepping(step, limits, stages);
}

lattice::TimeStepLimits Case::time_step_limits(const bool breaks) const
{
  if (breaks && has_contact)
    return lattice::time_step_limits(sheet(), material(), smallest_stable_stretch, contact_law());
  return lattice::time_step_limits(sheet(), material(), smallest_stable_stretch);
}

lattice::TimeStepping Case::lattice_time_stepping() const
{
  return time_stepping(false);
}

lattice::TimeStepping Case::fracture_time_stepping() const
{
  return time_stepping(true);
}

} // namespace latcon::input
