#pragma once

#include "lattice/chebyshev_stages.h"
#include "lattice/integrator.h"

namespace latcon::lattice
{

/// Runge-Kutta-Chebyshev method of second order for y = (x, v), y' = (v, a(x, v)) (theory.md, eqs. (L.17) to (L.20),
/// (L.22)).
///
/// Each of the s stages of a step evaluates all forces at its own positions and velocities. The stable step grows with
/// s^2, so that a given time takes fewer evaluations the longer the steps are.
class RungeKuttaChebyshev : public Integrator
{
public:
  /// @param time_step h [s], > 0
  /// @param stages s of steps of that length, >= 2
  RungeKuttaChebyshev(const RowPartition &band, Forces &forces, double time_step, unsigned int stages);

  /// Shorter steps take fewer stages: no more than (L.22) requires.
  void set_time_step(double time_step) override;
  void step(State &state) override;

private:
  /// Positions and velocities.
  struct Motion
  {
    Field x, y, vx, vy;
  };

  ChebyshevStages stages_;
  double damping_limit_; // beta over h of the stages and step at the start [1/s]
  Motion start_;         // of the step, in own rows
  Motion previous_;      // those of the stage before the one that the state holds
};

} // namespace latcon::lattice
