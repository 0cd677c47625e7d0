#pragma once

#include "lattice/forces.h"
#include "lattice/site_forces.h"

namespace lattice
{

/// Velocity Verlet for forces that depend on velocity (theory.md, eq. L.7):
///   v_half = v + (h/2) a,   x' = x + h v_half,   v_pred = v_half + (h/2) a,
///   a' = f(x', v_pred) / m, v' = v_half + (h/2) a'.
/// The dashpots see v_pred = v + h a, a second-order prediction of v', so the scheme stays explicit, takes one force
/// evaluation a step and converges at second order with and without viscosity. Without it, it is plain velocity Verlet.
///
/// Moves the rows of a band, and brings positions and predicted velocities in its halo up to date before each
/// evaluation.
class VelocityVerlet
{
public:
  /// @param time_step h [s], > 0; see TimeStepLimits
  /// @param band that of `forces`
  VelocityVerlet(const RowBand &band, Forces &forces, double time_step);

  double time_step() const { return time_step_; }

  /// Has forces act besides those of the bonds, at the same positions and velocities; they must outlive this object.
  void add(SiteForces &forces) { site_forces_.push_back(&forces); }

  /// Computes the accelerations a state starts with; needed once, and again after a change from outside. Collective.
  void initialise(State &state);

  /// Advances by one time step. Sites with zero inverse mass keep their velocity. Collective.
  void step(State &state);

  /// Velocities the last force evaluation was made with [m/s].
  const Field &evaluated_vx() const { return predicted_vx_; }
  const Field &evaluated_vy() const { return predicted_vy_; }

  /// Evaluates the added forces anew, at the last positions and velocities. Collective.
  void evaluate_site_forces(State &state);

  /// Accelerations at the end of the last step anew for those sites at `places` that are in the band, each of which
  /// lost bonds then, and for those that site forces act on by now, which may have become more.
  void update_accelerations(State &state, const std::vector<std::size_t> &places) const;

private:
  /// Positions and predicted velocities of a row at the end of a step, velocities half way.
  void drift(State &state, std::size_t row);
  /// Accelerations and velocities of a row at the end of a step, from the forces there.
  void kick(State &state, std::size_t row, const double *fx, const double *fy, double duration) const;
  std::vector<Field *> evaluated_fields(State &state);
  void update_all_images(State &state);
  /// Adds the site forces to the accelerations, and what they change of the velocities in `duration` [s].
  void add_site_forces(State &state, double duration) const;

  RowBand band_;
  const TriangularLattice &lattice_;
  HaloExchange halo_;
  Forces &forces_;
  double time_step_;
  std::vector<SiteForces *> site_forces_;
  Field predicted_vx_, predicted_vy_;
};

} // namespace lattice
