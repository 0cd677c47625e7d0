#include "lattice/triangular_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

std::size_t intervals(double extent, double pitch, bool is_even = false)
{
  const std::size_t multiple = is_even ? 2 : 1;
  support::require(extent < 1e9 * pitch, "a lattice has fewer than 1e9 rows and columns");
  return multiple * static_cast<std::size_t>(std::lround(extent / (static_cast<double>(multiple) * pitch)));
}

// A number of rows or columns that is given modulo 2^64.
double signed_number(std::size_t modulo)
{
  return static_cast<double>(static_cast<std::ptrdiff_t>(modulo));
}

// Returns whether half-bonds are those of the triangular lattice, of all shells or of the first two.
bool has_triangular_kinds(const Grid &grid, const std::vector<HalfBond> &stencil)
{
  const std::vector<HalfBond> triangular = triangular_stencil(grid);
  const auto key = [](const HalfBond &b) { return std::tuple(b.columns, b.rows, b.rest_length, b.weight, b.shell); };
  return grid.kind == Grid::Kind::triangular &&
         (stencil.size() == n_bond_kinds || stencil.size() == 2 * n_kinds_per_shell) &&
         std::equal(stencil.begin(), stencil.end(), triangular.begin(),
                    [key](const HalfBond &a, const HalfBond &b) { return key(a) == key(b); });
}

} // namespace

TriangularLattice::TriangularLattice(double spacing, double length, double height, Orientation orientation,
                                     Periodic periodic)
  : TriangularLattice({Grid::Kind::triangular, spacing, orientation},
                      triangular_stencil({Grid::Kind::triangular, spacing, orientation}), spacing, length, height,
                      periodic)
{
}

TriangularLattice::TriangularLattice(const Grid &grid, const std::vector<HalfBond> &stencil, double d, double length,
                                     double height, Periodic periodic)
  : grid_(grid), stencil_(stencil), d_(d), is_triangular_(has_triangular_kinds(grid, stencil)), periodic_(periodic)
{
  const double spacing = grid.spacing;
  support::require(spacing > 0. && length > 0. && height > 0. && d > 0.,
                   "a lattice needs positive spacing, length and height");
  support::require(!stencil.empty() && stencil.size() <= most_kinds, "a sheet has 1 to 127 half-bonds");
  for (std::size_t kind = 0; kind < n_kinds(); ++kind)
  {
    shortest_bond_ = std::min(shortest_bond_, rest_length(kind));
    reach_ = std::max(reach_, static_cast<std::size_t>(rows_across(kind)));
    for (const std::size_t row : {0u, 1u})
      column_reach_ = std::max(column_reach_, static_cast<std::size_t>(std::abs(columns_across(kind, row))));
  }
  // An odd number of sites across the crack puts one on the line y = 0; rows repeat in pairs.
  const double along = rows_along_x() ? length : height, across = rows_along_x() ? height : length;
  columns_ = repeats_along() ? intervals(along, spacing) : intervals(along, spacing, !rows_along_x()) + 1;
  rows_ = intervals(across, grid.pitch() * spacing, rows_along_x() || repeats_across()) + (repeats_across() ? 0 : 1);
  // The margin of a periodic sheet is filled from the sheet once around, so it must not be wider.
  support::require(
    columns_ >= (repeats_along() ? column_reach_ : 3) && rows_ >= (repeats_across() ? reach_ : 2),
    "the sheet is too small for its lattice spacing: fewer than two rows or three columns, or than bonds reach "
    "where it is periodic");
  const auto aligned = [](std::size_t n) { return (n + row_alignment - 1) / row_alignment * row_alignment; };
  first_column_ = aligned(column_reach_);
  stride_ = first_column_ + aligned(columns_ + column_reach_);
  if (periodic_.x || periodic_.y)
    find_images();
  if (grid.scatter.amplitude > 0.)
  {
    scattered_ = std::make_shared<const ScatteredBonds>(*this);
    shortest_bond_ = scattered_->shortest;
    for (std::size_t kind = 0; kind < n_kinds(); ++kind)
      stencil_[kind].weight = scattered_->bounding_weights[kind];
  }
}

void TriangularLattice::find_images()
{
  for (std::size_t place = 0; place < n_places(); ++place)
  {
    const std::size_t site = canonical_place(place);
    // Within reach of bonds, and not the missing end of an odd row.
    if (site != place && is_site(site) && column_of(place) + column_reach_ < columns_ + 2 * column_reach_)
      images_.push_back({place, site,
                         grid_.from_row_frame(signed_number(column_of(place) - column_of(site)),
                                              signed_number(row_of(place) - row_of(site)))});
  }
}

std::size_t TriangularLattice::canonical_place(std::size_t place) const
{
  if (!repeats_across() && !repeats_along())
    return place;
  // Margins are narrower than eight periods.
  return index(repeats_across() ? (row_of(place) + 8 * rows_) % rows_ : row_of(place),
               repeats_along() ? (column_of(place) + 8 * columns_) % columns_ : column_of(place));
}

std::vector<std::size_t> TriangularLattice::sites(Rows rows, Rows columns) const
{
  std::vector<std::size_t> places;
  for (std::size_t row = rows.begin; row < std::min(rows.end, rows_); ++row)
    for (std::size_t column = columns.begin; column < std::min(columns.end, sites_in_row(row)); ++column)
      places.push_back(index(row, column));
  return places;
}

std::optional<std::size_t> TriangularLattice::row(std::ptrdiff_t number) const
{
  const std::size_t row = row_of(canonical_place(index(static_cast<std::size_t>(number), 0)));
  return row < rows_ ? std::optional(row) : std::nullopt;
}

std::pair<Rows, Rows> TriangularLattice::window(const Eigen::Vector2d &lower, const Eigen::Vector2d &upper) const
{
  const auto [along, across] = rows_along_x() ? std::pair(0, 1) : std::pair(1, 0);
  const Eigen::Vector2d first = grid_point(index(0, 0));
  // One more at either end, since odd rows are shifted, and points scattered, by up to half a spacing.
  const auto between = [&](int axis, double pitch, std::size_t n)
  {
    const auto number = [&](double X, double more)
    { return static_cast<std::size_t>(std::clamp(std::floor((X - first[axis]) / pitch) + more, 0., double(n))); };
    return Rows{number(lower[axis], -1.), number(upper[axis], 2.)};
  };
  return {between(across, site_area() / spacing(), rows_), between(along, spacing(), columns_)};
}

Eigen::Vector2d TriangularLattice::reference(std::size_t place) const
{
  const Eigen::Vector2d X = grid_point(place);
  if (grid_.scatter.amplitude == 0.)
    return X;
  const std::size_t site = canonical_place(place);
  return X + grid_.spacing * grid_.scatter.displacement(row_of(site), column_of(site));
}

Eigen::Vector2d TriangularLattice::grid_point(std::size_t place) const
{
  const double across = signed_number(row_of(place));
  const double along = signed_number(column_of(place)) + (rows_shift() && row_of(place) % 2 != 0 ? 0.5 : 0.);
  // Centring before scaling keeps mirror sites at exactly opposite y.
  const double middle = 0.5 * static_cast<double>((rows_along_x() ? rows_ : columns_) - 1);
  return rows_along_x() ? grid_.from_row_frame(along, across - middle) : grid_.from_row_frame(along - middle, across);
}

} // namespace latcon::lattice
