#include "lattice/triangular_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lattice/bonds/require.h"

namespace latcon::lattice
{
namespace
{

std::size_t intervals(double extent, double pitch, bool is_even = false)
{
  const std::size_t multiple = is_even ? 2 : 1;
  require(extent < 1e9 * pitch, "a lattice has fewer than 1e9 rows and columns");
  return multiple * static_cast<std::size_t>(std::lround(extent / (static_cast<double>(multiple) * pitch)));
}

// Returns whether half-bonds are those of the triangular lattice, of all shells or of the first two.
bool has_triangular_kinds(const Grid &grid, const std::vector<HalfBond> &stencil)
{
  const std::vector<HalfBond> triangular = triangular_stencil(grid);
  return grid.kind == Grid::Kind::triangular &&
         (stencil.size() == n_bond_kinds || stencil.size() == 2 * n_kinds_per_shell) &&
         std::equal(stencil.begin(), stencil.end(), triangular.begin(),
                    [](const HalfBond &a, const HalfBond &b)
                    {
                      return a.columns == b.columns && a.rows == b.rows && a.rest_length == b.rest_length &&
                             a.weight == b.weight && a.shell == b.shell;
                    });
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
                                     double height, Periodic periodic, const Scatter &scatter)
  : grid_(grid), stencil_(stencil), d_(d), is_triangular_(has_triangular_kinds(grid, stencil)), periodic_(periodic),
    scatter_(scatter)
{
  const double spacing = grid.spacing;
  require(spacing > 0. && length > 0. && height > 0. && d > 0., "a lattice needs positive spacing, length and height");
  require(!stencil.empty() && stencil.size() <= most_kinds, "a sheet has 1 to 127 half-bonds");
  int columns_reach = 0;
  for (const HalfBond &bond : stencil_)
  {
    reach_ = std::max(reach_, static_cast<std::size_t>(bond.rows));
    for (const int odd : {0, 1})
      columns_reach = std::max(columns_reach, std::abs(bond.columns + (rows_shift() ? (bond.rows + odd) / 2 : 0)));
  }
  column_reach_ = static_cast<std::size_t>(columns_reach);
  // An odd number of sites across the crack puts one on the line y = 0; rows repeat in pairs.
  const double along = rows_along_x() ? length : height, across = rows_along_x() ? height : length;
  columns_ = repeats_along() ? intervals(along, spacing) : intervals(along, spacing, !rows_along_x()) + 1;
  rows_ = intervals(across, grid.pitch() * spacing, rows_along_x() || repeats_across()) + (repeats_across() ? 0 : 1);
  // The margin of a periodic sheet is filled from the sheet once around, so it must not be wider.
  require(columns_ >= (repeats_along() ? column_reach_ : 3) && rows_ >= (repeats_across() ? reach_ : 2),
          "the sheet is too small for its lattice spacing: fewer than two rows or three columns");
  const auto aligned = [](std::size_t n) { return (n + row_alignment - 1) / row_alignment * row_alignment; };
  first_column_ = aligned(column_reach_);
  stride_ = first_column_ + aligned(columns_ + column_reach_);
  find_images();
  if (scatter_.amplitude > 0.)
  {
    scattered_ = std::make_shared<const ScatteredBonds>(*this);
    for (std::size_t kind = 0; kind < n_kinds(); ++kind)
      stencil_[kind].weight = scattered_->bounding_weights[kind];
  }
}

void TriangularLattice::find_images()
{
  if (!periodic_.x && !periodic_.y)
    return;
  const auto beyond = static_cast<std::ptrdiff_t>(column_reach_), end = static_cast<std::ptrdiff_t>(columns_) + beyond;
  for (std::size_t place = 0; place < n_places(); ++place)
  {
    const std::size_t site = canonical_place(place);
    const auto [row, column] = numbers(place);
    const auto [site_row, site_column] = numbers(site);
    // Not the missing end of an odd row.
    if (site != place && is_site(site) && column >= -beyond && column < end)
      images_.push_back(
        {place, site,
         grid_.from_row_frame(static_cast<double>(column - site_column), static_cast<double>(row - site_row))});
  }
}

std::size_t TriangularLattice::canonical_place(std::size_t place) const
{
  const auto wrapped = [](std::ptrdiff_t number, std::size_t n)
  { return (number + 8 * static_cast<std::ptrdiff_t>(n)) % static_cast<std::ptrdiff_t>(n); };
  if (!periodic_.x && !periodic_.y)
    return place;
  const auto [row, column] = numbers(place);
  const std::ptrdiff_t up = repeats_across() ? wrapped(row, rows_) - row : 0;
  const std::ptrdiff_t along = repeats_along() ? wrapped(column, columns_) - column : 0;
  return place + static_cast<std::size_t>(up) * stride() + static_cast<std::size_t>(along); // modulo 2^64
}

std::vector<std::size_t> TriangularLattice::sites(Rows rows, Rows columns) const
{
  std::vector<std::size_t> places;
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    for (std::size_t column = columns.begin; column < std::min(columns.end, sites_in_row(row)); ++column)
      places.push_back(index(row, column));
  return places;
}

std::optional<std::size_t> TriangularLattice::row(std::ptrdiff_t number) const
{
  const auto n = static_cast<std::ptrdiff_t>(rows_);
  if (repeats_across())
    number = (number + n) % n;
  return number >= 0 && number < n ? std::optional(static_cast<std::size_t>(number)) : std::nullopt;
}

double TriangularLattice::shortest_bond() const
{
  const auto is_shorter = [](const HalfBond &a, const HalfBond &b) { return a.rest_length < b.rest_length; };
  return scattered_ ? scattered_->shortest
                    : std::min_element(stencil_.begin(), stencil_.end(), is_shorter)->rest_length;
}

std::pair<Rows, Rows> TriangularLattice::window(const Eigen::Vector2d &lower, const Eigen::Vector2d &upper) const
{
  const auto [along, across] = rows_along_x() ? std::pair(0, 1) : std::pair(1, 0);
  const Eigen::Vector2d first = grid_point(index(0, 0));
  // One more at either end, since odd rows are shifted.
  const auto between = [&](int axis, double pitch, std::size_t n)
  {
    const auto clamped = [n](double number) { return static_cast<std::size_t>(std::clamp(number, 0., double(n))); };
    const double scatter = scatter_.amplitude * grid_.spacing;
    return Rows{clamped(std::floor((lower[axis] - first[axis] - scatter) / pitch) - 1.),
                clamped(std::floor((upper[axis] - first[axis] + scatter) / pitch) + 2.)};
  };
  return {between(across, site_area() / spacing(), rows_), between(along, spacing(), columns_)};
}

Eigen::Vector2d TriangularLattice::reference(std::size_t place) const
{
  const Eigen::Vector2d X = grid_point(place);
  if (scatter_.amplitude == 0.)
    return X;
  const auto [row, column] = numbers(canonical_place(place));
  return X + grid_.spacing * scatter_.displacement(row, column);
}

Eigen::Vector2d TriangularLattice::grid_point(std::size_t place) const
{
  const auto [row, column] = numbers(place);
  const double along = static_cast<double>(column) + (rows_shift() && row % 2 != 0 ? 0.5 : 0.);
  const double across = static_cast<double>(row);
  // Centring before scaling keeps mirror sites at exactly opposite y.
  if (rows_along_x())
    return grid_.from_row_frame(along, across - 0.5 * static_cast<double>(rows_ - 1));
  return grid_.from_row_frame(along - 0.5 * static_cast<double>(columns_ - 1), across);
}

} // namespace latcon::lattice
