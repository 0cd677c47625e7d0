#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "lattice/integrator.h"
#include "support/require.h"

namespace latcon::lattice
{

/// Velocity v0 + L X of sites at X in the undeformed sheet.
struct AffineVelocity
{
  Eigen::Vector2d translation = Eigen::Vector2d::Zero(); ///< v0 [m/s]
  Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();    ///< L [1/s]

  Eigen::Vector2d at(const Eigen::Vector2d &X) const { return translation + gradient * X; }
  bool operator==(const AffineVelocity &other) const
  {
    return translation == other.translation && gradient == other.gradient;
  }
};

/// Sites whose motion is prescribed along x, along y or both: edges that move, rollers, grips.
struct Constraint
{
  /// Mean velocity of a time interval [s].
  using Motion = std::function<AffineVelocity(double from, double to)>;

  std::vector<std::size_t> sites; ///< the same on all ranks
  bool along_x = true, along_y = true;
  /// Sites keep the velocity during a time step, so that they are in place at its end; null: they stand.
  Motion motion = {};
  double until = std::numeric_limits<double>::infinity(); ///< time from which on the sites are free [s]
};

/// All held sites.
std::vector<std::size_t> held_sites(const State &state, const TriangularLattice &lattice);

/// A velocity that does not change.
Constraint::Motion steady(const Eigen::Matrix2d &velocity_gradient);

/// The motion x = F(t) X, F piecewise linear in time; before the first instant and after the last one it stands.
/// @param times [s], increasing @param deformations F at these times, as many
/// @throws std::invalid_argument for other times
Constraint::Motion piecewise_linear(std::vector<double> times, std::vector<Eigen::Matrix2d> deformations);

/// Marks sites as constrained in the rows that `band` knows, as a Simulation does; before add_noise(), so that they
/// stay in place. @throws std::invalid_argument for what is no site
void constrain(State &state, const RowPartition &band, const Constraint &constraint);

/// A constraint of a sheet in motion. Removed sites are left out.
class PrescribedMotion
{
public:
  PrescribedMotion(const RowPartition &band, Constraint constraint);

  /// Returns whether a component of a site would be prescribed twice.
  bool overlaps(const PrescribedMotion &other) const;

  void set_motion(Constraint::Motion motion) { constraint_.motion = std::move(motion); }

  /// Gives the sites their velocity of a time interval [s], or lets them go with the velocity that they have.
  /// @param work of each row [J/m], to which their kinetic energy is added then @return whether anything changed: the
  /// same on all ranks
  bool prescribe(State &state, const Material &material, double from, double to, std::vector<double> &work);

  /// Adds the power of the constraint on the sheet, -f . v over the components prescribed, f being all forces on a site
  /// [W/m]. @param on_sites those of the bonds [N/m] @param site_forces others @param of_rows one per row
  void add_power(const State &state, const VectorField &on_sites, const std::vector<const SiteForces *> &site_forces,
                 std::vector<double> &of_rows) const;

  /// Saves or loads what changes, besides the state; see Simulation.
  template <class Archive>
  void archive(Archive &archive)
  {
    std::vector<double> velocity{velocity_.translation(0), velocity_.translation(1), velocity_.gradient(0, 0),
                                 velocity_.gradient(0, 1), velocity_.gradient(1, 0), velocity_.gradient(1, 1)};
    archive("velocity", velocity);
    archive("released", released_);
    if constexpr (Archive::loads)
    {
      support::require(velocity.size() == 6, "`velocity` of a constraint has six numbers");
      velocity_.translation << velocity[0], velocity[1];
      velocity_.gradient << velocity[2], velocity[3], velocity[4], velocity[5];
    }
  }
  /// Constrains the sites, whose velocities become 0, as when the sheet was set up.
  void hold(State &state) const { constrain(state, band_, constraint_); }
  /// Frees the sites, if they were let go, in a state that was set up with them constrained.
  void free_if_released(State &state, const Material &material) const;

private:
  RowPartition band_;
  Constraint constraint_;
  AffineVelocity velocity_;
  int released_ = 0; // 1: yes
};

} // namespace latcon::lattice
