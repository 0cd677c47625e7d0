#pragma once

#include <memory>
#include <vector>

#include "continuum/damage/damage_solver.h"

namespace latcon::claims
{

/// Returns F = diag(stretch, 1) of a bar in uniaxial strain.
[[nodiscard]] dealii::Tensor<2, 2> uniaxial(double stretch);

/// Returns the stretch at which uniaxial strain reaches an energy density [J/m^3]. @throws std::domain_error if it does
/// not up to 1e6
[[nodiscard]] double stretch_of_energy(const continuum::Material &law, double energy);

/// Bar with damage, one row of square elements of degree 2, in uniaxial strain: both ends held, and the long edges held
/// across the bar (theory-damage.md, eqs. (C.66) to (C.68)). All functions are collective.
class DamagedBar
{
public:
  /// @param laws of the undamaged material
  /// @param damage threshold, length and residual stiffness
  /// @param size side h of an element, and height of the bar [m], > 0
  /// @param cells number of elements along the bar; odd for weaken_middle()
  /// @param last largest stretch [-] of the bar, at load factor 1; > 1
  DamagedBar(const continuum::Constitution &laws, const continuum::DamageLaw &damage, double size, unsigned int cells,
             double last);

  /// Gives the nodes of the middle column of elements the initial damage `amount` [-], from 0 to 1. To be called before
  /// the first stretch().
  void weaken_middle(double amount);

  /// Loads the bar in one quasi-static load step until its length is `stretch` [-] times that at rest: 1 to `last` of
  /// the constructor, also less than before.
  /// @throws as continuum::DamageSolver::step_to
  void stretch(double stretch) { solver_->step_to((stretch - 1.) / (last_ - 1.)); }

  double length() const { return length_; } ///< [m]
  double height() const { return height_; } ///< [m]
  /// P_xX at the right end [Pa].
  double stress() const;
  /// Damage at the nodes, from the left.
  std::vector<double> profile() const;
  const continuum::DamageSolver &solver() const { return *solver_; }

private:
  dealii::parallel::distributed::Triangulation<2> mesh_;
  double length_, height_, last_;
  std::unique_ptr<continuum::DamageSolver> solver_;
};

} // namespace latcon::claims
