#pragma once

// One time step of DynamicSolver; private to its sources.

#include "continuum/dynamic_solver.h"

namespace latcon::continuum
{
/// State at the beginning of a step (vectors without ghost entries), and Newmark's formulas for its end.
struct DynamicSolver::Step
{
  NewmarkParameters rule;
  double dt;
  Vector u;
  Vector v;
  Vector a;
  double first_release_share;
  double last_release_share;

  double mean_release_share() const
  {
    return rule.alpha_f * first_release_share + (1. - rule.alpha_f) * last_release_share;
  }

  Vector last_acceleration(const Vector &last_u) const
  {
    Vector a_1 = last_u;
    a_1 -= u;
    a_1.add(-dt, v);
    a_1.sadd(1. / (rule.beta * dt * dt), 1. - 0.5 / rule.beta, a);
    return a_1;
  }

  Vector last_velocity(const Vector &last_acceleration) const
  {
    Vector v_1 = v;
    v_1.add(dt * (1. - rule.gamma), a, dt * rule.gamma, last_acceleration);
    return v_1;
  }

  static Vector mean(const double first_share, const Vector &first, const Vector &last)
  {
    Vector x = last;
    x.sadd(1. - first_share, first_share, first);
    return x;
  }
};

/// Residual of the equation of motion for a given displacement at the end of a step.
struct DynamicSolver::Residual
{
  Vector u_mean;    // with ghost entries [m]
  Vector v_mean;    // with ghost entries [m/s]
  Vector residual;  // [N/m]
  Vector magnitude; // sums of the absolute values of its terms [N/m]
  double free;      // norm of the residual over the free unknowns [N/m]
  double reference; // norm of internal, viscous and inertial forces and loads over all unknowns [N/m]
  double energy;    // of the mean state, minus the work of dead loads [J/m]
};
} // namespace latcon::continuum
