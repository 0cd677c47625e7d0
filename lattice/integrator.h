#pragma once

#include <utility>
#include <vector>

#include "lattice/chebyshev_stages.h"
#include "lattice/fracture.h"
#include "lattice/site_forces.h"

namespace latcon::lattice
{

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

  /// Finds the components of own sites that keep their velocity in `state`; for a state that was loaded, otherwise
  /// initialise() does.
  void find_rollers(const State &state);

  /// Computes the accelerations a state starts with; needed once, and again after a change from outside. Collective.
  void initialise(State &state);

  /// Advances by one time step. Sites with zero inverse mass keep their velocity. Collective.
  virtual void step(State &state) = 0;

  /// Velocities the last force evaluation was made with [m/s], `state` being that of the last call.
  const VectorField &evaluated_velocity(const State &state) const
  {
    return predicted_velocity_.x.empty() ? state.velocity : predicted_velocity_;
  }

  /// Evaluates the added forces anew, at the last positions and velocities. Collective.
  void evaluate_site_forces(State &state);

  /// Updates forces and accelerations of own rows at the ends of bonds that broke at the end of the last step, with the
  /// site forces as last evaluated.
  void update_accelerations(State &state, const std::vector<BrokenBond> &broken);

protected:
  /// Brings what forces are evaluated at up to date in the halo and at images. Collective.
  void exchange_ghosts(State &state);
  /// Evaluates the forces of bonds, see Forces::evaluate, and the added ones, at the same positions and velocities.
  void evaluate(State &state, const Forces::RowFunction &post_force, BondHistory *history = nullptr,
                double lookahead = 0.);
  /// Computes the accelerations by all forces at the present positions and velocities. Updates the memory of bonds.
  /// @param lookahead of breaking [s], see Forces::evaluate. Half of a long step makes bonds break at the end of the
  /// step that is nearest to the moment, neither late nor early in the mean
  void accelerate(State &state, double lookahead = 0.);
  /// Adds the accelerations by site forces to those of a state; along a roller's fixed component there is none.
  void accelerate_sites(State &state);
  /// Adds to the velocities what site forces change of them in `duration` [s].
  void kick_sites(State &state, double duration) const;

  RowPartition band_;
  const TriangularLattice &lattice_;
  Forces &forces_;
  VectorField predicted_velocity_; // that forces are evaluated at; empty: that of the state

private:
  VectorField &evaluated(State &state) { return predicted_velocity_.x.empty() ? state.velocity : predicted_velocity_; }
  void accelerate_row(State &state, std::size_t row, const Forces::OfRow &force) const;

  SitesOfRanks sent_, received_; // of the halo
  double time_step_;
  std::vector<SiteForces *> site_forces_;
  struct RollerVelocity
  {
    std::size_t place, axis;
    double velocity; // [m/s]
  };
  std::vector<RollerVelocity> rollers_;
  /// Places and accelerations [m/s^2] before each of the site forces was added.
  std::vector<std::pair<std::size_t, Eigen::Vector2d>> of_bonds_;
};

/// Velocity Verlet for forces that depend on velocity (theory.md, eq. (L.7)):
///   v_half = v + (h/2) a,   x' = x + h v_half,   v_pred = v_half + (h/2) a,
///   a' = f(x', v_pred) / m, v' = v_half + (h/2) a'.
/// The dashpots see v_pred = v + h a, a second-order prediction of v', so the scheme stays explicit, takes one force
/// evaluation a step and converges at second order with and without viscosity. Without it, it is plain velocity Verlet.
class VelocityVerlet : public Integrator
{
public:
  /// @param time_step h [s], > 0; see TimeStepLimits
  VelocityVerlet(const RowPartition &band, Forces &forces, double time_step);
  void step(State &state) override;
};

/// Runge-Kutta-Chebyshev method of second order for y = (x, v), y' = (v, a(x, v)) (theory.md, eqs. (L.17) to (L.20),
/// (L.22)).
///
/// Each of the s stages of a step evaluates all forces at its own positions and velocities. The stable step grows with
/// s^2, so that a given time takes fewer evaluations the longer the steps are. Shorter steps take fewer stages: no more
/// than (L.22) requires.
class RungeKuttaChebyshev : public Integrator
{
public:
  /// @param time_step h [s], > 0 @param stages s of steps of that length, >= 2
  RungeKuttaChebyshev(const RowPartition &band, Forces &forces, double time_step, unsigned int stages);
  void set_time_step(double time_step) override;
  void step(State &state) override;

private:
  struct Motion
  {
    VectorField position, velocity;
  };

  ChebyshevStages stages_;
  double damping_limit_; // beta over h of the stages and step at the start [1/s]
  Motion start_;         // of the step, in own rows
  Motion previous_;      // those of the stage before the one that the state holds
};

} // namespace latcon::lattice
