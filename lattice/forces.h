#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/state.h"

namespace lattice
{

/// Forces on all sites from all bonds: the hot loop, and the one place to make faster.
///
/// A bond pulls with A0 psi'(lam) + A0 eta (v_rel . n) / l along its current direction n (theory.md, eq. L.3).
/// Two passes over the rows: every bond once, then every site gathers its twelve bonds in an order that is symmetric
/// under both mirrors of the lattice. So the bits of a result depend neither on the number of threads nor on which side
/// of a symmetry line a site stands.
class Forces
{
public:
  Forces(const TriangularLattice &lattice, const Material &material);

  /// Bonds below this stretch, still unbroken at their first breaking stretch, count as events too, per kind.
  /// For toughening on retraction; 0 (no such event) by default. `initial_breaking_stretch` tells toughened bonds
  /// apart.
  void watch_retraction(const std::array<double, n_bond_kinds> &stretch, double initial_breaking_stretch);

  /// Computes the force on every site at positions state.x, y and the given velocities [m/s], those of images included.
  /// Forces at held sites are those the bonds exert on them.
  void evaluate(const State &state, const Field &vx, const Field &vy);

  const Field &fx() const { return fx_; } ///< force per sheet thickness [N/m]
  const Field &fy() const { return fy_; }

  /// Power the dashpots dissipated at the last evaluation, sum of A0 eta (v_rel . n)^2 / l [W/m].
  double viscous_power() const { return viscous_power_; }

  /// Whether a row holds bonds that were stretched past their limit (or retracted) at the last evaluation.
  bool row_has_events(std::size_t row) const { return row_events_[row] > 0.; }

  /// Takes a bond that has just broken out of the last evaluation, as if it had been absent there.
  void remove_bond(const State &state, const Field &vx, const Field &vy, std::size_t place, std::size_t kind);

private:
  void bonds_of_row(std::size_t row, const State &state, const Field &vx, const Field &vy);
  void gather_row(std::size_t row);

  const TriangularLattice &lattice_;
  struct Kind
  {
    const Shell *shell; // nullptr: no such bonds
    double rest_length;
    double cross_section;
    double damping; // A0 eta / l
    double retraction_stretch = 0.;
  };
  std::array<Kind, n_bond_kinds> kinds_;
  double initial_breaking_stretch_ = 0.;

  std::array<Field, n_bond_kinds> bond_fx_, bond_fy_;
  Field fx_, fy_;
  Field row_viscous_power_;
  std::vector<double> row_events_;
  double viscous_power_ = 0.;
};

} // namespace lattice
