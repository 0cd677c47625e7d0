#pragma once

#include "lattice/integrator.h"

namespace latcon::lattice
{

/// Velocity Verlet for forces that depend on velocity (theory.md, eq. (L.7)):
///   v_half = v + (h/2) a,   x' = x + h v_half,   v_pred = v_half + (h/2) a,
///   a' = f(x', v_pred) / m, v' = v_half + (h/2) a'.
/// The dashpots see v_pred = v + h a, a second-order prediction of v', so the scheme stays explicit, takes one force
/// evaluation a step and converges at second order with and without viscosity. Without it, it is plain velocity Verlet.
///
/// Moves the rows of a band, and brings positions and predicted velocities in its halo up to date before each
/// evaluation.
class VelocityVerlet : public Integrator
{
public:
  /// @param time_step h [s], > 0; see TimeStepLimits
  VelocityVerlet(const RowPartition &band, Forces &forces, double time_step);

  void step(State &state) override;
};

} // namespace latcon::lattice
