#pragma once

#include <array>
#include <vector>

#include "lattice/state.h"

namespace lattice
{

/// Forces on all sites from all bonds: the hot loop, and the one place to make faster.
///
/// A bond pulls with A0 psi'(lam) + A0 eta (v_rel . n) / l along its current direction n (theory.md, eq. L.3).
/// Every thread takes some of the rows from its lower to its upper end. It computes the bonds that start in a row,
/// keeps those of the last three rows, and lets the sites of the row gather their twelve bonds while these are in
/// cache. Bonds that reach into a band from below are computed once more there. The order of a gather is symmetric
/// under both mirrors of the lattice, so the bits of a result depend neither on the number of threads nor on which side
/// of a symmetry line a site stands.
class Forces
{
public:
  /// @param band rows whose sites are to get their forces, of the whole sheet or of the share of a rank
  Forces(const RowBand &band, const Material &material);

  /// Bonds below this stretch, still unbroken at their first breaking stretch, count as events too, per kind.
  /// For toughening on retraction; 0 (no such event) by default. `initial_breaking_stretch` tells toughened bonds
  /// apart.
  void watch_retraction(const std::array<double, n_bond_kinds> &stretch, double initial_breaking_stretch);

  /// Computes the force on every site of the band at positions state.x, y and the given velocities [m/s], those of
  /// images included. Forces at held sites are those the bonds exert on them.
  void evaluate(const State &state, const Field &vx, const Field &vy);

  const Field &fx() const { return fx_; } ///< force per sheet thickness [N/m]
  const Field &fy() const { return fy_; }

  /// Power the dashpots dissipated at the last evaluation, sum of A0 eta (v_rel . n)^2 / l [W/m] over the bonds that
  /// start in each row, row by row.
  const std::vector<double> &row_viscous_power() const { return row_viscous_power_; }
  /// The same of the band.
  double viscous_power() const;

  /// Whether a row holds bonds that were stretched past their limit (or retracted) at the last evaluation.
  bool row_has_events(std::size_t row) const { return row_events_[row] > 0.; }

  /// Takes a bond that has just broken out of the last evaluation, as if it had been absent there: the forces on those
  /// of its two ends that are in the band are summed anew, over the bonds that they have by now.
  /// @param state as at that evaluation, but for the bond's breaking stretch, which is 0
  /// @param vx,vy velocities of that evaluation
  void remove_bond(const State &state, const Field &vx, const Field &vy, std::size_t place, std::size_t kind);

  /// What the bonds of one kind have in common.
  struct Bond
  {
    double rest_length;             // l [m]
    double cross_section;           // A0 / h [m]
    double damping;                 // A0 eta / (h l)
    double retraction_stretch = 0.; // 0: not watched
  };

  struct BondForce
  {
    double x, y; // on the near end, the opposite on the far end
    double stretch;
    double viscous_power;
  };

  /// Sums over the bonds that start in a row.
  struct RowSums
  {
    double viscous_power = 0.;
    double events = 0.; // a count; SSE2 has no 64-bit integer comparisons to vectorise with
  };

private:
  /// Forces on the near ends of the bonds that start in the last three rows, which is as far down as neighbours are.
  class BondRows
  {
  public:
    explicit BondRows(std::size_t stride) : stride_(stride), values_(n_rows * n_bond_kinds * 2 * stride, 0.) {}

    /// The x (0) or y (1) component for the bonds of a kind that start in a row >= -2: column 0, with two places of
    /// margin on either side.
    double *at(std::ptrdiff_t row, std::size_t kind, std::size_t component)
    {
      const std::size_t slot = static_cast<std::size_t>(row + n_rows) % n_rows;
      return &values_[((slot * n_bond_kinds + kind) * 2 + component) * stride_ + 2];
    }

  private:
    static constexpr std::ptrdiff_t n_rows = 3;
    std::size_t stride_;
    Field values_;
  };

  /// What an evaluation depends on.
  struct Motion
  {
    const State &state;
    const Field &vx, &vy;
  };

  void evaluate_rows(const Motion &motion, std::ptrdiff_t begin, std::ptrdiff_t end, BondRows &bonds);
  void bonds_from_below(const Motion &motion, std::ptrdiff_t row, BondRows &bonds) const;
  RowSums bonds_of_row(const Motion &motion, std::size_t from, std::ptrdiff_t row, BondRows &bonds) const;
  void gather_row(std::ptrdiff_t row, BondRows &bonds);
  BondForce single_bond(const Motion &motion, std::size_t place, std::size_t kind, double breaking_stretch) const;
  void sum_site(const Motion &motion, std::size_t place);

  RowBand band_;
  const TriangularLattice &lattice_;
  std::array<const Shell *, n_bond_kinds> shells_; // nullptr: no such bonds
  std::array<Bond, n_bond_kinds> kinds_;
  double initial_breaking_stretch_ = 0.;
  bool rows_repeat_;    // periodic across the rows
  bool columns_repeat_; // periodic along them

  std::vector<BondRows> bond_rows_; // one a thread
  Field fx_, fy_;
  std::vector<double> row_viscous_power_;
  std::vector<double> row_events_;
};

} // namespace lattice
