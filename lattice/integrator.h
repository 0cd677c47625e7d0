#pragma once

#include "lattice/forces.h"
#include "lattice/site_forces.h"

namespace lattice
{

/// Advances a sheet in time, step by step. The forces at the end of a step are those the next one starts with; in
/// between bonds can be taken out of them.
class Integrator
{
public:
  /// @param time_step h [s], > 0
  /// @throws std::invalid_argument for any other
  Integrator(const TriangularLattice &lattice, Forces &forces, double time_step);
  Integrator(const Integrator &) = delete; // refers to parts of a simulation
  Integrator &operator=(const Integrator &) = delete;
  virtual ~Integrator() = default;

  double time_step() const { return time_step_; }

  /// Has forces act besides those of the bonds, at the same positions and velocities; they must outlive this object.
  void add(SiteForces &forces) { site_forces_.push_back(&forces); }

  /// Computes the accelerations a state starts with; needed once, and again after a change from outside.
  virtual void initialise(State &state) = 0;

  /// Advances by one time step. Sites with zero inverse mass keep their velocity.
  virtual void step(State &state) = 0;

  /// Velocities the last force evaluation was made with [m/s], `state` being that of the last call.
  virtual const Field &evaluated_vx(const State &state) const = 0;
  virtual const Field &evaluated_vy(const State &state) const = 0;

  /// Accelerations anew from the forces as they stand, after bonds were taken out of them or site forces changed.
  void update_accelerations(State &state) const;

protected:
  /// The forces of bonds and of all that was added, at the positions of a state and the given velocities.
  void evaluate(State &state, const Field &vx, const Field &vy);
  /// Adds the accelerations by site forces to those of a state.
  void accelerate_sites(State &state) const;
  /// Adds to the velocities what site forces change of them in `duration` [s].
  void kick_sites(State &state, double duration) const;

  const TriangularLattice &lattice_;
  Forces &forces_;

private:
  double time_step_;
  std::vector<SiteForces *> site_forces_;
};

} // namespace lattice
