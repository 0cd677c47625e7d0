#pragma once

#include <utility>
#include <vector>

#include "lattice/forces.h"
#include "lattice/site_forces.h"

namespace latcon::lattice
{

/// A component of the velocity of a site that is prescribed while the other one is free.
struct RollerVelocity
{
  std::size_t place;
  unsigned int component; ///< 0: x, 1: y
  double velocity;        ///< [m/s]
};

/// Advances the rows of a band in time, step by step. The forces at the end of a step are those the next one starts
/// with; in between bonds can be taken out of them.
class Integrator
{
public:
  /// @param band that of `forces`
  /// @param time_step h [s], > 0
  /// @throws std::invalid_argument for any other
  Integrator(const RowPartition &band, Forces &forces, double time_step);
  Integrator(const Integrator &) = delete; // refers to parts of a simulation
  Integrator &operator=(const Integrator &) = delete;
  virtual ~Integrator() = default;

  double time_step() const { return time_step_; } ///< h [s]

  /// Sets h [s] of the steps to come, > 0.
  virtual void set_time_step(double time_step) { time_step_ = time_step; }

  /// Adds forces to those of the bonds, at the same positions and velocities; they must outlive this object.
  void add(SiteForces &forces) { site_forces_.push_back(&forces); }

  /// Sets the components of own sites that keep a velocity while the other one follows the forces.
  void set_rollers(std::vector<RollerVelocity> rollers) { rollers_ = std::move(rollers); }

  /// Computes the accelerations a state starts with; needed once, and again after a change from outside. Collective.
  virtual void initialise(State &state) = 0;

  /// Advances by one time step. Sites with zero inverse mass keep their velocity. Collective.
  virtual void step(State &state) = 0;

  /// Velocities the last force evaluation was made with [m/s], `state` being that of the last call.
  virtual const Field &evaluated_vx(const State &state) const = 0;
  virtual const Field &evaluated_vy(const State &state) const = 0;

  /// Evaluates the added forces anew, at the last positions and velocities. Collective.
  void evaluate_site_forces(State &state);

  /// Accelerations at the end of the last step anew for those sites at `places` that are in the band, each of which
  /// lost bonds then, and for those that site forces act on by now, which may have become more.
  void update_accelerations(State &state, const std::vector<std::size_t> &places) const;

protected:
  /// Positions and velocities that forces are evaluated at: x, y, vx, vy.
  virtual std::vector<Field *> evaluated_fields(State &state) = 0;
  /// Brings these up to date in the halo and at images. Collective.
  void exchange_ghosts(State &state);
  void update_all_images(State &state);
  /// Accelerations and velocities of a row after forces on its sites have acted for `duration` [s].
  void kick(State &state, std::size_t row, const double *fx, const double *fy, double duration) const;
  /// Forces of bonds and of all that was added, at the present positions and velocities, as accelerations.
  /// @param history of the state, to be updated; nullptr: none
  void accelerate(State &state, BondHistory *history = nullptr);
  /// Adds the accelerations by site forces to those of a state; along a roller's fixed component there is none.
  void accelerate_sites(State &state) const;
  /// Adds to the velocities what site forces change of them in `duration` [s].
  void kick_sites(State &state, double duration) const;

  RowPartition band_;
  const TriangularLattice &lattice_;
  HaloExchange halo_;
  Forces &forces_;

private:
  double time_step_;
  std::vector<SiteForces *> site_forces_;
  std::vector<RollerVelocity> rollers_;
};

} // namespace latcon::lattice
