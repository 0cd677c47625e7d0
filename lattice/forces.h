#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "lattice/row_kernels.h"
#include "lattice/state.h"

namespace latcon::lattice
{

/// Forces on all sites from all bonds. The loops over a row are in row_kernels.h.
///
/// A bond pulls with A0 psi'(lam) + A0 eta (v_rel . n) / l along its current direction n (theory.md, eq. (L.3)), and
/// with the overstress A0 q of its memory (eq. (L.27)) if the state has a history. Every thread computes some of the
/// rows from the lowest up: the bonds that start in a row, then the sums of its sites, which gather the bonds of the
/// last three rows while these are in cache. Bonds that reach into its rows from below it computes once more. The order
/// of a gather is symmetric under both mirrors of the triangular lattice, so the bits of a result depend neither on the
/// number of threads nor on which side of a symmetry line a site stands. Other stencils have too many half-bonds to
/// keep: each adds to the sums of the sites at its ends, in the order of rows and half-bonds.
class Forces
{
public:
  /// @param band rows whose sites are to get their forces, of the whole sheet or of the share of a rank
  Forces(const RowPartition &band, const Material &material);

  /// Bonds below this stretch that are not toughened count as events too, per kind: all positive, or none (no such
  /// event), which is the default. For toughening on retraction.
  void set_retraction_threshold(const std::vector<double> &stretch) { retraction_stretch_ = stretch; }

  /// Sets the stretch below which bonds are short [-], but for linear ones; 0: none is, the default.
  void set_shortness_threshold(double stretch) { shortness_limit_ = 1. / stretch; }

  /// Sets the time since the last update of the memory of bonds, in which they reached the positions at which forces
  /// are evaluated next [s], >= 0; 0 by default and from each update on.
  void set_elapsed(double duration);

  /// Components of the forces on the sites of a row [N/m].
  using OfRow = std::array<double *, 2>;
  /// Takes the forces on the sites of a row while they are in cache; may not change positions and velocities.
  using RowFunction = std::function<void(std::size_t row, const OfRow &force)>;
  /// Computes the force on every site of the band at the positions of the state and the given velocities [m/s], those
  /// of images included. Forces at held sites are those the bonds exert on them.
  /// @param post_force called once per row, in any order, by several threads; may be empty
  /// @param history that of the state, to be updated to its positions; nullptr: none
  /// @param lookahead [s], >= 0: bonds whose ends will be too far apart after they have moved for so long at these
  /// velocities, which must be known in the halo then, count as past their limit; 0: those that are past it
  /// @param beside called once by the calling thread, while others are at the rows; may be empty, and may throw
  /// @throws std::invalid_argument for a negative lookahead
  void evaluate(const State &state, const VectorField &velocity, const RowFunction &post_force,
                BondHistory *history = nullptr, double lookahead = 0., const std::function<void()> &beside = {});
  /// Evaluates the forces into on_sites().
  void evaluate(const State &state, const VectorField &velocity);
  /// Computes the forces on the sites of one row of the band anew, and the sums over its bonds, at the positions and
  /// velocities [m/s] of the last evaluation, where bonds have been lost since.
  void evaluate_row(const State &state, const VectorField &velocity, std::size_t row, const RowFunction &post_force);

  /// Keeps the forces on the sites of a row in on_sites(), from the next evaluation on.
  void keep(std::size_t row) { is_kept_[row] = true; }
  const VectorField &on_sites() const { return on_sites_; } ///< per sheet thickness, in rows that are kept [N/m]

  /// Sums over the bonds that start in a row of the band, as of the last evaluation.
  const kernels::RowSums &row_sums(std::size_t row) const { return row_sums_[row]; }
  double lookahead() const { return lookahead_; } ///< of the last evaluation [s]
  /// Returns whether RowSums::mechanism_power is an energy, which is no part of the viscous power.
  bool gives_energy(std::size_t mechanism) const { return mechanism_gives_energy_[mechanism]; }

  /// Returns whether one of the short bonds that start in a row of the band has at most a stretch of `stretch` [-], or
  /// will have it in `ahead` [s] at its rate now, with the velocities [m/s] of the last evaluation.
  bool row_has_short_bonds_ahead(const State &state, const VectorField &velocity, std::size_t row, double ahead,
                                 double stretch) const;

private:
  /// Forces in the last n rows, as far as they are known.
  class LastRows
  {
  public:
    LastRows(const TriangularLattice &lattice, std::ptrdiff_t n)
      : stride_(lattice.stride()), column_(lattice.index(0, 0) % stride_), n_(n),
        values_(2 * static_cast<std::size_t>(n) * stride_, 0.)
    {
    }
    /// The components along x and y in a row >= -n, or any if n is 1: column 0.
    std::array<double *, 2> at(std::ptrdiff_t row)
    {
      double *const x = &values_[2 * static_cast<std::size_t>((row + n_) % n_) * stride_ + column_];
      return {{x, x + stride_}};
    }
    void clear() { std::fill(values_.begin(), values_.end(), 0.); }
    void clear(std::ptrdiff_t row) { std::fill_n(at(row)[0] - column_, 2 * stride_, 0.); }

  private:
    std::size_t stride_, column_;
    std::ptrdiff_t n_;
    Field values_;
  };

  /// Input of an evaluation.
  struct Motion
  {
    const State &state;
    const VectorField &velocity;
    BondHistory *history = nullptr; // updated
  };

  /// Scratch arrays of a thread.
  struct Scratch
  {
    Scratch(const TriangularLattice &lattice, std::size_t n_kinds)
      : sums(lattice, lattice.is_triangular() ? 1 : static_cast<std::ptrdiff_t>(lattice.reach()) + 1),
        lengths(4 * n_kinds_per_shell * lattice.stride())
    {
      for (std::size_t kind = 0; kind < (lattice.is_triangular() ? n_kinds : 1); ++kind)
        bonds.emplace_back(lattice, lattice.is_triangular() ? lattice.rows_across(kind) + 1 : 1);
    }
    /// On the near ends of the bonds that start in a row: of each kind of the triangular lattice, in as many rows as
    /// the neighbours of a site through these bonds are down, and in its own; of one kind after the other of other
    /// stencils.
    std::vector<LastRows> bonds = {};
    LastRows sums; // on the sites of the rows that bonds reach from one row
    std::vector<kernels::BondsOfKind> kinds = {};
    std::vector<kernels::RememberedRow> remembered = {}; // by kind
    Field lengths;                                       // of the bonds of a row with a memory, and their inverse
    double duration = 0.;                                // from the start of an evaluation to the end of its rows [s]
  };

  void evaluate_rows(const Motion &updating, std::ptrdiff_t begin, std::ptrdiff_t end, Scratch &scratch,
                     const RowFunction &post_force);
  kernels::RowOfBonds row_of_bonds(const Motion &motion, std::size_t row,
                                   std::vector<kernels::BondsOfKind> &kinds) const;
  kernels::RowSums bonds_of_row(const Motion &motion, std::size_t from, std::ptrdiff_t row, std::ptrdiff_t begin,
                                Scratch &scratch) const;
  void gather_row(std::ptrdiff_t row, Scratch &scratch) const;
  void remember(const Motion &motion, std::size_t row, std::size_t kind, double *mechanism_power,
                Scratch &scratch) const;

  RowPartition band_;
  const TriangularLattice &lattice_;
  Material material_;                             // whose memories have the duration of set_elapsed()
  std::size_t n_kinds_;                           // of bonds: the first so many
  std::ptrdiff_t reach_;                          // of these, in rows
  std::vector<kernels::BondConstants> constants_; // by kind
  std::vector<double> retraction_stretch_;        // by kind; none: not watched
  double shortness_limit_ = std::numeric_limits<double>::infinity();
  bool columns_repeat_; // periodic along the rows
  double lookahead_ = 0.;
  // Rows that the first thread gets less than each other one, so that all end at once: the others start later, and the
  // first has work beside its rows. Negative: it gets more.
  double fewer_rows_ = 0.;

  std::vector<Scratch> scratch_; // one a thread
  VectorField on_sites_;
  std::vector<bool> is_kept_; // by row
  std::vector<kernels::RowSums> row_sums_;
  std::vector<bool> mechanism_gives_energy_;
};

} // namespace latcon::lattice
