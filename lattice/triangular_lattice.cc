#include "lattice/triangular_lattice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace latcon::lattice
{
namespace
{

const double half_sqrt3 = std::sqrt(3.) / 2.;

// A bond vector in the row frame.
struct RowFrameVector
{
  int halves; // along the row, in units of d / 2
  int rows;   // across the rows, in units of their pitch
};

constexpr std::array<RowFrameVector, n_bond_kinds> bond_directions{
  {{2, 0}, {1, 1}, {-1, 1}, {3, 1}, {-3, 1}, {0, 2}, {4, 0}, {2, 2}, {-2, 2}}};

std::size_t intervals(double extent, double pitch)
{
  if (!(extent < 1e9 * pitch))
    throw std::invalid_argument("a lattice has fewer than 1e9 rows and columns");
  return static_cast<std::size_t>(std::lround(extent / pitch));
}

// An odd number of sites across the crack puts one on the line y = 0.
std::size_t even_intervals(double extent, double pitch)
{
  return 2 * intervals(extent, 2. * pitch);
}

} // namespace

TriangularLattice::TriangularLattice(double spacing, double length, double height, Orientation orientation,
                                     Periodic periodic)
  : spacing_(spacing), orientation_(orientation)
{
  if (!(spacing > 0.) || !(length > 0.) || !(height > 0.))
    throw std::invalid_argument("a lattice needs positive spacing, length and height");
  const double pitch = half_sqrt3 * spacing;
  const bool rows_along_x = orientation == Orientation::rows_along_crack;
  periodic_along_ = rows_along_x ? periodic.x : periodic.y;
  periodic_across_ = rows_along_x ? periodic.y : periodic.x;

  const double along = rows_along_x ? length : height;
  const double across = rows_along_x ? height : length;
  if (periodic_along_)
    columns_ = intervals(along, spacing);
  else
    columns_ = (rows_along_x ? intervals(along, spacing) : even_intervals(along, spacing)) + 1;
  if (periodic_across_)
    rows_ = even_intervals(across, pitch);
  else
    rows_ = (rows_along_x ? even_intervals(across, pitch) : intervals(across, pitch)) + 1;
  // The margin of a periodic sheet is filled from the sheet once around, so it must not be wider.
  if (columns_ < (periodic_along_ ? margin : 3) || rows_ < 2)
    throw std::invalid_argument("the sheet is too small for its lattice spacing: fewer than two rows or three columns");
  stride_ = row_alignment * (1 + (columns_ + margin + row_alignment - 1) / row_alignment);
  find_images();
}

Periodic TriangularLattice::periodic() const
{
  return orientation_ == Orientation::rows_along_crack ? Periodic{periodic_along_, periodic_across_}
                                                       : Periodic{periodic_across_, periodic_along_};
}

double TriangularLattice::length() const
{
  const double along = static_cast<double>(periodic_along_ ? columns_ : columns_ - 1);
  const double across = static_cast<double>(periodic_across_ ? rows_ : rows_ - 1);
  return from_row_frame(along, across).x();
}

double TriangularLattice::height() const
{
  const double along = static_cast<double>(periodic_along_ ? columns_ : columns_ - 1);
  const double across = static_cast<double>(periodic_across_ ? rows_ : rows_ - 1);
  return from_row_frame(along, across).y();
}

double TriangularLattice::site_area() const
{
  return half_sqrt3 * spacing_ * spacing_;
}

bool TriangularLattice::is_site(std::size_t place) const
{
  const std::size_t padded_row = place / stride();
  const std::size_t padded_column = place % stride();
  if (padded_row < margin || padded_row >= rows_ + margin || padded_column < row_alignment)
    return false;
  return padded_column - row_alignment < sites_in_row(padded_row - margin);
}

void TriangularLattice::find_images()
{
  if (!periodic_along_ && !periodic_across_)
    return;
  const std::size_t width = stride();
  for (std::size_t place = 0; place < n_places(); ++place)
  {
    const std::size_t padded_row = place / width, padded_column = place % width;
    const bool below = padded_row < margin, above = padded_row >= rows_ + margin;
    const bool left = padded_column < row_alignment, right = padded_column >= columns_ + row_alignment;
    if (padded_column + margin < row_alignment || padded_column >= columns_ + row_alignment + margin)
      continue;
    if (!below && !above && !left && !right)
    {
      place += columns_ - 1; // on to the right end of the row
      continue;
    }
    if (((below || above) && !periodic_across_) || ((left || right) && !periodic_along_))
      continue;
    const std::size_t row = below ? padded_row + rows_ : above ? padded_row - rows_ : padded_row;
    const std::size_t column = left ? padded_column + columns_ : right ? padded_column - columns_ : padded_column;
    const std::size_t site = row * width + column;
    if (!is_site(site))
      continue; // the missing end of an odd row
    const auto turns = [](bool before, bool after) { return after ? 1. : before ? -1. : 0.; };
    images_.push_back({place, site,
                       from_row_frame(turns(left, right) * static_cast<double>(columns_),
                                      turns(below, above) * static_cast<double>(rows_))});
  }
}

const TriangularLattice::Image *TriangularLattice::site_of_image(std::size_t place) const
{
  const auto found = std::lower_bound(images_.begin(), images_.end(), place,
                                      [](const Image &image, std::size_t wanted) { return image.place < wanted; });
  return found != images_.end() && found->place == place ? &*found : nullptr;
}

std::size_t TriangularLattice::canonical_place(std::size_t place) const
{
  if (images_.empty())
    return place;
  const Image *image = site_of_image(place);
  return image != nullptr ? image->site : place;
}

std::optional<std::size_t> TriangularLattice::row(std::ptrdiff_t number) const
{
  const auto n = static_cast<std::ptrdiff_t>(rows_);
  if (periodic_across_)
    number = (number + n) % n;
  return number >= 0 && number < n ? std::optional(static_cast<std::size_t>(number)) : std::nullopt;
}

Eigen::Vector2d TriangularLattice::reference(std::size_t place) const
{
  const auto row = static_cast<std::ptrdiff_t>(place / stride()) - static_cast<std::ptrdiff_t>(margin);
  const auto column = static_cast<std::ptrdiff_t>(place % stride()) - static_cast<std::ptrdiff_t>(row_alignment);
  const double along = static_cast<double>(column) + (row % 2 != 0 ? 0.5 : 0.);
  const double across = static_cast<double>(row);
  // Centring before scaling keeps mirror sites at exactly opposite y.
  if (orientation_ == Orientation::rows_along_crack)
    return from_row_frame(along, across - 0.5 * static_cast<double>(rows_ - 1));
  return from_row_frame(along - 0.5 * static_cast<double>(columns_ - 1), across);
}

std::ptrdiff_t TriangularLattice::rows_across(std::size_t kind)
{
  return bond_directions[kind].rows;
}

std::size_t TriangularLattice::shift(std::size_t kind, std::size_t row) const
{
  // A bond to a row of the other parity leads half a spacing to one side, and rows of odd numbers begin there.
  const auto &[halves, rows] = bond_directions[kind];
  const int columns = rows % 2 == 0 ? halves / 2 : (halves - 1) / 2 + static_cast<int>(row % 2);
  return static_cast<std::size_t>(rows) * stride() + static_cast<std::size_t>(columns);
}

Eigen::Vector2d TriangularLattice::bond_vector(std::size_t kind) const
{
  return from_row_frame(0.5 * bond_directions[kind].halves, bond_directions[kind].rows);
}

double TriangularLattice::rest_length(std::size_t kind) const
{
  const std::array<double, n_shells> in_spacings{{1., 2. * half_sqrt3, 2.}};
  return in_spacings[shell_of(kind)] * spacing_;
}

Eigen::Vector2d TriangularLattice::from_row_frame(double along, double across) const
{
  const double u = along * spacing_;
  const double v = across * half_sqrt3 * spacing_;
  return orientation_ == Orientation::rows_along_crack ? Eigen::Vector2d(u, v) : Eigen::Vector2d(v, u);
}

} // namespace latcon::lattice
