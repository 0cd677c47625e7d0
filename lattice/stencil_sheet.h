#pragma once

#include <optional>
#include <vector>

#include "lattice/chebyshev_stages.h"
#include "lattice/energy.h"
#include "lattice/fracture.h"
#include "lattice/stencil.h"
#include "lattice/stencil_kernels.h"

namespace latcon::lattice
{

/// A rectangular sheet of a nonlocal continuum: points of a grid joined by the bonds of a stencil, stretched, held at
/// its edges, moved by Runge-Kutta-Chebyshev, with bonds that break for good.
///
/// The sheet is 0 <= X <= length, |Y| <= height / 2. Points that lack a neighbour within the stencil's reach beyond an
/// edge are held, as on the lattice. A bond of weight q stores c V q psi per thickness, V being the area of a point and
/// c = 3 s l / d that of the lattice's shell of length l (theory.md, eq. (L.4)); so the triangular stencil of six
/// directions is the lattice of spacing d. Its dashpot has the shell's viscosity. Memories, disorder, contact, ranks
/// and toughening other than behind the tip are not there.
///
/// Results have the same bits for any number of threads and on all instruction sets.
class StencilSheet
{
public:
  /// @param origin reference position of the point at column 0, row 0 of the grid [m]
  /// @param d spacing of the lattice whose shells the rings are [m], > 0
  /// @param F of the stretched sheet at rest
  /// @param step of time h [s], > 0; as many stages as are stable with the dashpots of a whole point
  /// @throws std::invalid_argument for shells with memory or without dashpots, disorder, or a sheet without free points
  StencilSheet(const Grid &grid, const Eigen::Vector2d &origin, double length, double height, const Material &material,
               double d, const std::vector<Ring> &rings, const Eigen::Matrix2d &F, double step);

  /// Longest step that resolves waves and breaking: that of the lattice, 0.35 of the elastic limit of velocity Verlet
  /// at F = I [s]. It does not depend on the spacing of the grid.
  double resolving_step() const;
  unsigned int stages() const { return stages_.count(); }
  const std::vector<HalfBond> &stencil() const { return stencil_; }
  std::size_t n_sites() const { return n_sites_; }

  /// Place of the point at a column and row of the grid; none outside the sheet.
  std::optional<std::size_t> place(int column, int row) const;
  Eigen::Vector2d reference(std::size_t place) const;                                  ///< X [m]
  Eigen::Vector2d position(std::size_t place) const { return {x_[place], y_[place]}; } ///< x [m]
  bool held(std::size_t place) const { return !(inverse_mass_[place] > 0.); }
  bool present(std::size_t place, std::size_t half_bond) const { return bonds_.present(place, half_bond); }

  /// Moves every free point by a random displacement, uniform in [-amplitude, amplitude] along x and y [m].
  void add_noise(double amplitude, std::uint64_t seed);
  /// Cuts the bonds whose reference line crosses the segment from (from, Y) to (to, Y). @return their number
  std::size_t cut(double from, double to, double Y);
  /// Lets bonds break beyond a stretch, and the more behind the tip. Default: they never do.
  /// @throws std::invalid_argument for values out of range
  void let_break(double breaking_stretch, BehindTipToughening toughening);

  /// Advances by one step. @return bonds that broke at its end, `kind` being the number in the stencil
  /// @throws std::runtime_error if positions are no longer finite
  const std::vector<BrokenBond> &step();

  double time() const { return time_; } ///< [s]
  /// Right-most free point that has lost at least a quarter of its bonds, as Fracture has it.
  std::optional<std::size_t> tip() const { return tip_.place; }
  /// Contact and boundary work are 0: there is none.
  EnergyBalance energies() const;

private:
  struct Row
  {
    int first, last;   // columns with points, last not included
    std::size_t begin; // place of the first
    std::size_t n() const { return static_cast<std::size_t>(last - first); }
  };

  kernels::BondsOfKind bonds_of(const Row &row, std::size_t half_bond) const;
  kernels::RowOfBonds sites_of(const Row &row, const kernels::BondsOfKind &bonds) const;
  Bond bond(std::size_t near, std::size_t k) const { return {near, k, near + static_cast<std::size_t>(shift_[k])}; }
  template <class Work> // work(bond)
  void for_each_bond_of_row(std::size_t row, const Work &work) const;
  template <class Work> // work(first row, end row)
  void in_threads(const Work &work) const;
  void evaluate();
  double bond_energy(const Bond &bond) const;
  double stretch_of(const Bond &bond) const;
  void lose(const Bond &bond);
  void consider_tip(std::size_t place);
  void toughen_behind_tip();
  void break_bonds();

  Grid grid_;
  Eigen::Vector2d origin_;
  Material material_;
  std::vector<HalfBond> stencil_;
  std::vector<kernels::BondConstants> constants_; // of half-bonds
  std::vector<std::ptrdiff_t> shift_;             // of places, to far ends
  double mass_;
  double step_;
  ChebyshevStages stages_{2};
  int first_column_, first_row_; // of the stored ones, margin included
  std::size_t stride_, n_places_, n_sites_ = 0;
  std::size_t reach_; // of bonds, in rows
  std::vector<Row> rows_;
  Field x_, y_, vx_, vy_, fx_, fy_, ax_, ay_, inverse_mass_;
  Field start_x_, start_y_, start_vx_, start_vy_, previous_x_, previous_y_, previous_vx_, previous_vy_;
  BondStates bonds_;
  std::vector<unsigned int> lost_;
  Field row_power_;
  double time_ = 0., power_ = 0.; // of dashpots
  double viscous_ = 0., broken_energy_ = 0., initial_ = 0.;
  double breaking_stretch_ = unbreakable, toughened_stretch_ = unbreakable, toughening_distance_ = 0.;
  double toughened_to_ = -unbreakable; // X behind which all bonds are toughened
  CrackTip tip_;
  std::vector<BrokenBond> broken_;
};

} // namespace latcon::lattice
