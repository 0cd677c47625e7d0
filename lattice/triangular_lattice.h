#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "lattice/scatter.h"
#include "lattice/stencil.h"

namespace latcon::lattice
{

/// The rows, or columns, begin, begin + 1, ... end - 1.
struct Rows
{
  std::size_t begin, end;
};

/// Directions along which the sheet repeats itself without end.
struct Periodic
{
  bool x = false;
  bool y = false;
};

/// Half-bonds of the triangular lattice in each shell. Kinds 0 to 2 are nearest neighbours, 3 to 5 next-nearest, 6 to 8
/// third-nearest.
inline constexpr std::size_t n_kinds_per_shell = 3;
inline constexpr std::size_t n_bond_kinds = n_shells * n_kinds_per_shell; ///< of all shells

/// Shell of a kind of bonds of the triangular lattice.
constexpr std::size_t shell_of(std::size_t kind)
{
  return kind / n_kinds_per_shell;
}

/// A bond, by the places of its ends. Whatever belongs to a bond is stored by the place where it starts and its kind.
struct Bond
{
  std::size_t near; ///< where it starts
  std::size_t kind; ///< number of its half-bond in the stencil of the lattice
  std::size_t far;  ///< where it ends; an image where it crosses the edge of a periodic sheet
};

/// A rectangular sheet in its reference configuration: sites of a grid, joined by the half-bonds of a stencil.
///
/// The stencil is that of the triangular lattice (theory.md, section "The lattice"), or of rings of bonds on a
/// triangular or square grid. Sites of a triangular grid stand in rows, spacing h along a row, row
/// pitch (sqrt3 / 2) h, every second row shifted by h / 2 and one site shorter. The sheet is its own mirror image about
/// the line y = 0, to the last bit of its coordinates. About the centre line along y it is, to round-off, if the number
/// of rows is odd, as it always is with rows along x; not if it is even, since the first row then has a site more than
/// the last. With rows along x:
///
///     row 2   o     o     o     o        even rows: `columns()` sites
///     row 1      o     o     o           odd rows:  one site fewer
///     row 0   o     o     o     o
///
/// Storage is row by row with a margin on every side as wide as bonds reach, so that the neighbour of a site through a
/// bond of kind k is always at the same offset in rows of one parity, whether that neighbour exists or not. Rows begin
/// at multiples of `row_alignment` places, and as many may be worked on at once. The margin is empty, except where the
/// sheet is periodic: there the places next to the sheet hold images of the sites at the other end. In a sheet that
/// is periodic along its rows all rows have `columns()` sites; one that is periodic across them has an even number of
/// rows.
class TriangularLattice
{
public:
  /// @param spacing d [m], > 0
  /// @param length extent along x [m], > 0
  /// @param height extent along y [m], > 0
  /// Both extents are rounded to whole rows and columns, an odd number of them across y, so that one runs along y = 0;
  /// a periodic extent to whole periods of the lattice.
  /// @throws std::invalid_argument if an extent is not positive or holds fewer than two rows or three columns, or 1e9
  TriangularLattice(double spacing, double length, double height, Orientation orientation, Periodic periodic = {});

  /// A sheet of a nonlocal continuum.
  /// @param stencil of the grid, by increasing shell; see ring_stencil()
  /// @param d spacing of the lattice whose shells the rings are [m], > 0
  /// @throws std::invalid_argument also for more half-bonds than `most_kinds`
  TriangularLattice(const Grid &grid, const std::vector<HalfBond> &stencil, double d, double length, double height,
                    Periodic periodic = {});
  static constexpr std::size_t most_kinds = 127; ///< half-bonds: those that a site has lost are counted in a byte

  double spacing() const { return grid_.spacing; } ///< h [m], distance of nearest sites; d of the triangular lattice
  double lattice_spacing() const { return d_; }    ///< d [m], of the lattice whose shells the rings are, or its own
  Orientation orientation() const { return grid_.orientation; }
  const Grid &grid() const { return grid_; }
  Periodic periodic() const { return periodic_; }
  double length() const { return extent().x(); } ///< distance of the outermost sites along x, or the period [m]
  double height() const { return extent().y(); } ///< the same along y [m]
  /// Reference area V of one site [m^2], (sqrt3 / 2) d^2 of the triangular lattice.
  double site_area() const { return grid_.pitch() * spacing() * spacing(); }

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; } ///< sites in an even row
  std::size_t sites_in_row(std::size_t row) const { return columns_ - (rows_alternate() ? row % 2 : 0); }
  /// Number of a site, counted row by row from the lower left without gaps; what files call it.
  std::size_t site_number(std::size_t place) const
  {
    return row_of(place) * columns_ - (rows_alternate() ? row_of(place) / 2 : 0) + column_of(place);
  }
  std::size_t n_sites() const { return site_number(index(rows_, 0)); }
  std::size_t stride() const { return stride_; }                           ///< places per row, margin included
  std::size_t n_places() const { return (rows_ + 2 * reach_) * stride(); } ///< length of every field, margin included
  static constexpr std::size_t row_alignment = 8;                          ///< in places: 64 bytes of a field

  /// Place of a site in every field; column < sites_in_row(row).
  std::size_t index(std::size_t row, std::size_t column) const
  {
    return (row + reach_) * stride() + first_column_ + column;
  }
  /// Returns the row of this number, wrapped in a sheet that is periodic across rows; none outside of other sheets.
  std::optional<std::size_t> row(std::ptrdiff_t number) const;
  /// Row of a place; in the margin below the sheet a negative number modulo 2^64, beyond all rows.
  std::size_t row_of(std::size_t place) const { return place / stride() - reach_; }
  /// Column of a place, likewise in the margin to the left.
  std::size_t column_of(std::size_t place) const { return place % stride() - first_column_; }
  /// Returns whether a place, margin included, has a site that is not an image.
  bool is_site(std::size_t place) const
  {
    return row_of(place) < rows_ && column_of(place) < sites_in_row(row_of(place));
  }
  static constexpr Rows all{0, std::numeric_limits<std::size_t>::max()}; ///< rows, or columns
  /// Places of the sites in some rows and columns, row by row.
  std::vector<std::size_t> sites(Rows rows = all, Rows columns = all) const;

  /// A place in the margin that is the image of a site one period away.
  struct Image
  {
    std::size_t place;
    std::size_t site;       ///< place of the site itself
    Eigen::Vector2d period; ///< reference vector from the site to its image [m]
  };
  /// All images, in the order of their places; none unless the sheet is periodic.
  const std::vector<Image> &images() const { return images_; }
  /// Returns whether a place has a site or an image of one.
  bool is_occupied(std::size_t place) const { return is_site(canonical_place(place)); }
  /// The site that stands at a place or has its image there: what fields over sites are summed at.
  std::size_t canonical_place(std::size_t place) const;

  /// Rows and columns that contain all sites, and some others, with a reference position between two corners [m].
  std::pair<Rows, Rows> window(const Eigen::Vector2d &lower, const Eigen::Vector2d &upper) const;

  /// Reference position (X, Y) [m] of a place; X from 0 to length(), Y centred on 0. Valid in the margin as well.
  Eigen::Vector2d reference(std::size_t place) const;
  /// The same before points are scattered.
  Eigen::Vector2d grid_point(std::size_t place) const;

  /// Returns the bond of a kind that starts at a place; its far end need not be a site.
  Bond bond(std::size_t near, std::size_t kind) const { return {near, kind, near + shift(kind, row_of(near))}; }
  /// Returns the bond of a kind that ends at a site, or at its image; its near end need not be a site.
  Bond bond_into(std::size_t site, std::size_t kind) const
  {
    return bond(canonical_place(site - shift(kind, row_of(site) + static_cast<std::size_t>(rows_across(kind)))), kind);
  }
  std::size_t n_kinds() const { return stencil_.size(); } ///< half-bonds of the stencil
  std::size_t shell(std::size_t kind) const { return stencil_[kind].shell; }
  /// Returns whether the half-bonds are those of the triangular lattice: of all three shells, or of the first two.
  bool is_triangular() const { return is_triangular_; }
  /// Rows from the start to the end of a bond of a kind, 0 to reach().
  std::ptrdiff_t rows_across(std::size_t kind) const { return stencil_[kind].rows; }
  /// Columns from the start, in `row`, to the end of a bond of a kind.
  std::ptrdiff_t columns_across(std::size_t kind, std::size_t row) const
  {
    // A bond to a row of the other parity leads half a spacing to one side, and rows of odd numbers begin there.
    const HalfBond &bond = stencil_[kind];
    return bond.columns + (rows_shift() ? (bond.rows + static_cast<int>(row % 2)) / 2 : 0);
  }
  /// Offset from a place in `row` to the end of the bond of a kind that starts there, modulo 2^64.
  std::size_t shift(std::size_t kind, std::size_t row) const
  {
    return static_cast<std::size_t>(rows_across(kind)) * stride() + static_cast<std::size_t>(columns_across(kind, row));
  }

  /// Reference bond vector R = X_neighbour - X_site of kind k [m]; that of the grid where points are scattered.
  const Eigen::Vector2d &bond_vector(std::size_t kind) const { return stencil_[kind].vector; }
  /// Rest length |R| [m], likewise.
  double rest_length(std::size_t kind) const { return stencil_[kind].rest_length; }
  double ring_radius(std::size_t kind) const { return stencil_[kind].radius; } ///< of its ring [m]

  /// Bonds of scattered points; nullptr on a grid, where all bonds of a kind are alike.
  const ScatteredBonds *scattered() const { return scattered_.get(); }
  /// Returns whether the bond of a kind that starts at a place is one of its ring.
  bool has_bond(std::size_t near, std::size_t kind) const { return length_ratio(near, kind) > 0.; }
  /// Rest length of the kind over that of a bond [-]; 0: no bond.
  double length_ratio(std::size_t near, std::size_t kind) const
  {
    return scattered_ ? scattered_->length_ratios[kind][near] : 1.;
  }
  /// Reference vector of a bond [m].
  Eigen::Vector2d bond_vector(const Bond &bond) const
  {
    return scattered_ ? Eigen::Vector2d(reference(bond.far) - reference(bond.near)) : bond_vector(bond.kind);
  }
  double shortest_bond() const { return shortest_bond_; } ///< its rest length [m]
  /// D [m]: a bond of cross-section s V / D per sheet thickness, s being the area factor of its shell, has its share of
  /// the energy of the shell. The spacing d on the triangular lattice; d |R| / (3 q l) for a weight q in a ring of
  /// radius l. Where points are scattered it is that of a bound, and bonds have factors; see State::stiffness.
  double section_length(std::size_t kind) const
  {
    const HalfBond &bond = stencil_[kind];
    return d_ * (bond.rest_length / bond.radius) / (3. * bond.weight);
  }
  std::size_t reach() const { return reach_; }               ///< of bonds, in rows
  std::size_t column_reach() const { return column_reach_; } ///< of bonds, in places along a row

private:
  bool rows_shift() const { return grid_.kind == Grid::Kind::triangular; }
  bool rows_along_x() const { return orientation() == Orientation::rows_along_crack; }
  bool repeats_along() const { return rows_along_x() ? periodic_.x : periodic_.y; }  // the rows
  bool repeats_across() const { return rows_along_x() ? periodic_.y : periodic_.x; } // the rows
  bool rows_alternate() const { return rows_shift() && !repeats_along(); }           // in length
  Eigen::Vector2d extent() const
  {
    return grid_.from_row_frame(static_cast<double>(repeats_along() ? columns_ : columns_ - 1),
                                static_cast<double>(repeats_across() ? rows_ : rows_ - 1));
  }
  void find_images();

  Grid grid_;
  std::vector<HalfBond> stencil_;
  double d_;
  bool is_triangular_;
  std::size_t reach_ = 0, column_reach_ = 0;
  double shortest_bond_ = std::numeric_limits<double>::infinity();
  std::size_t first_column_; // place of column 0 in its row
  Periodic periodic_;
  std::size_t rows_;
  std::size_t columns_;
  std::size_t stride_;
  std::vector<Image> images_;
  std::shared_ptr<const ScatteredBonds> scattered_;
};

} // namespace latcon::lattice
