#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace latcon::lattice
{

/// Direction of the rows of nearest neighbours. The crack runs along x.
enum class Orientation
{
  rows_along_crack, ///< NN bonds at 0, 60, 120 degrees to x, NNN bonds at 30, 90, 150
  rows_across_crack ///< turned by 30 degrees: NN bonds at 30, 90, 150, NNN bonds at 0, 60, 120
};

/// Directions along which the sheet repeats itself without end.
struct Periodic
{
  bool x = false;
  bool y = false;
};

/// Shells of bonds, by increasing rest length: nearest neighbours (d), next-nearest (sqrt3 d) and third-nearest (2 d,
/// in the directions of the nearest). A material need not have all of them.
inline constexpr std::size_t n_shells = 3;
/// What the shells are called in files and messages.
inline constexpr std::array<const char *, n_shells> shell_names{{"nearest", "next-nearest", "third-nearest"}};

/// Half of the bonds that a site has in each shell, each named by its direction in the row frame (along the row, across
/// the rows). The other half are the same bonds seen from their far ends. Kinds 0 to 2 are nearest neighbours, 3 to 5
/// next-nearest, 6 to 8 third-nearest.
inline constexpr std::size_t n_kinds_per_shell = 3;
inline constexpr std::size_t n_bond_kinds = n_shells * n_kinds_per_shell; ///< of all shells
inline constexpr std::size_t n_nearest_kinds = n_kinds_per_shell;         ///< of them nearest neighbours

/// Shell of a kind of bonds.
constexpr std::size_t shell_of(std::size_t kind)
{
  return kind / n_kinds_per_shell;
}

/// A bond, by the places of its ends. Whatever belongs to a bond is stored by the place where it starts and its kind.
struct Bond
{
  std::size_t near; ///< where it starts
  std::size_t kind; ///< see n_bond_kinds
  std::size_t far;  ///< where it ends; an image where it crosses the edge of a periodic sheet
};

/// A rectangular piece of the triangular lattice in its reference configuration (theory.md, section "The lattice").
///
/// Sites stand in rows, spacing d along a row, row pitch (sqrt3 / 2) d, every second row shifted by d / 2 and one site
/// shorter. The sheet is its own mirror image about the line y = 0, to the last bit of its coordinates. About the
/// centre line along y it is, to round-off, if the number of rows is odd, as it always is with rows along x; not if it
/// is even, since the first row then has a site more than the last. With rows along x:
///
///     row 2   o     o     o     o        even rows: `columns()` sites
///     row 1      o     o     o           odd rows:  one site fewer
///     row 0   o     o     o     o
///
/// Storage is row by row with a margin of at least two places on every side, so that the neighbour of a site through a
/// bond of kind k is always at the same offset in rows of one parity, whether that neighbour exists or not. Rows begin
/// at multiples of `row_alignment` places, and as many may be worked on at once. The margin is empty, except where the
/// sheet is periodic: there the two places next to the sheet hold images of the sites at the other end. In a sheet that
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

  double spacing() const { return spacing_; } ///< d [m]
  Orientation orientation() const { return orientation_; }
  Periodic periodic() const;
  double length() const; ///< distance of the outermost sites along x after rounding, or the period [m]
  double height() const; ///< the same along y [m]
  /// Reference area of one site, (sqrt3 / 2) d^2 [m^2].
  double site_area() const;

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; } ///< sites in an even row
  std::size_t sites_in_row(std::size_t row) const { return periodic_along_ ? columns_ : columns_ - row % 2; }
  /// Number of a site, counted row by row from the lower left without gaps; what files call it.
  std::size_t site_number(std::size_t place) const
  {
    const std::size_t row = row_of(place);
    return row * columns_ - (periodic_along_ ? 0 : row / 2) + column_of(place);
  }
  std::size_t n_sites() const { return rows_ * columns_ - (periodic_along_ ? 0 : rows_ / 2); }
  std::size_t stride() const { return stride_; }                           ///< places per row, margin included
  std::size_t n_places() const { return (rows_ + 2 * margin) * stride(); } ///< length of every field, margin included
  static constexpr std::size_t row_alignment = 8;                          ///< in places: 64 bytes of a field

  /// Place of a site in every field; column < sites_in_row(row).
  std::size_t index(std::size_t row, std::size_t column) const
  {
    return (row + margin) * stride() + row_alignment + column;
  }
  /// Returns the row of this number, wrapped in a sheet that is periodic across rows; none outside of other sheets.
  std::optional<std::size_t> row(std::ptrdiff_t number) const;
  std::size_t row_of(std::size_t place) const { return place / stride() - margin; }
  std::size_t column_of(std::size_t place) const { return place % stride() - row_alignment; }
  /// Returns whether a place, margin included, has a site that is not an image.
  bool is_site(std::size_t place) const;

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
  bool is_occupied(std::size_t place) const { return is_site(place) || site_of_image(place) != nullptr; }
  /// The site that stands at a place or has its image there: what fields over sites are summed at.
  std::size_t canonical_place(std::size_t place) const;

  /// Reference position (X, Y) [m] of a place; X from 0 to length(), Y centred on 0. Valid in the margin as well.
  Eigen::Vector2d reference(std::size_t place) const;

  /// Returns the bond of a kind that starts at a place; its far end need not be a site.
  Bond bond(std::size_t near, std::size_t kind) const { return {near, kind, near + shift(kind, row_of(near))}; }
  /// Returns the bond of a kind that ends at a site, or at its image; its near end need not be a site.
  Bond bond_into(std::size_t site, std::size_t kind) const
  {
    return bond(canonical_place(site - shift(kind, row_of(site) + static_cast<std::size_t>(rows_across(kind)))), kind);
  }
  /// Rows from the start to the end of a bond of a kind, 0 to `reach`.
  static std::ptrdiff_t rows_across(std::size_t kind);
  /// Offset from a place in `row` to the end of the bond of a kind that starts there, modulo 2^64.
  std::size_t shift(std::size_t kind, std::size_t row) const;

  /// Reference bond vector R = X_neighbour - X_site of kind k [m].
  Eigen::Vector2d bond_vector(std::size_t kind) const;
  /// Rest length |R|: d, sqrt3 d or 2 d [m].
  double rest_length(std::size_t kind) const;
  static bool is_nearest(std::size_t kind) { return kind < n_nearest_kinds; }
  static constexpr std::size_t reach = 2; ///< of bonds, in rows and in places along a row

private:
  static constexpr std::size_t margin = reach;

  Eigen::Vector2d from_row_frame(double along, double across) const;
  const Image *site_of_image(std::size_t place) const;
  void find_images();

  double spacing_;
  Orientation orientation_;
  bool periodic_along_;  // the rows
  bool periodic_across_; // the rows
  std::size_t rows_;
  std::size_t columns_;
  std::size_t stride_;
  std::vector<Image> images_;
};

} // namespace latcon::lattice
