#include "lattice/triangular_lattice.h"

#include <cmath>
#include <stdexcept>

namespace lattice
{
namespace
{

const double half_sqrt3 = std::sqrt(3.) / 2.;

struct RowFrameVector
{
  double along;  // in units of d
  double across; // in units of the row pitch
};

constexpr std::array<RowFrameVector, n_bond_kinds> bond_directions{
  {{1., 0.}, {0.5, 1.}, {-0.5, 1.}, {1.5, 1.}, {-1.5, 1.}, {0., 2.}}};

std::size_t intervals(double extent, double pitch)
{
  return static_cast<std::size_t>(std::lround(extent / pitch));
}

// An odd number of sites across the crack puts one on the line y = 0.
std::size_t even_intervals(double extent, double pitch)
{
  return 2 * intervals(extent, 2. * pitch);
}

} // namespace

TriangularLattice::TriangularLattice(double spacing, double length, double height, Orientation orientation)
  : spacing_(spacing), orientation_(orientation)
{
  if (!(spacing > 0.) || !(length > 0.) || !(height > 0.))
    throw std::invalid_argument("a lattice needs positive spacing, length and height");
  const double pitch = half_sqrt3 * spacing;
  if (orientation == Orientation::rows_along_crack)
  {
    columns_ = intervals(length, spacing) + 1;
    rows_ = even_intervals(height, pitch) + 1;
  }
  else
  {
    columns_ = even_intervals(height, spacing) + 1;
    rows_ = intervals(length, pitch) + 1;
  }
  if (columns_ < 3 || rows_ < 2)
    throw std::invalid_argument("the sheet is too small for its lattice spacing: fewer than two rows or three columns");
}

double TriangularLattice::length() const
{
  return orientation_ == Orientation::rows_along_crack ? static_cast<double>(columns_ - 1) * spacing_
                                                       : static_cast<double>(rows_ - 1) * half_sqrt3 * spacing_;
}

double TriangularLattice::height() const
{
  return orientation_ == Orientation::rows_along_crack ? static_cast<double>(rows_ - 1) * half_sqrt3 * spacing_
                                                       : static_cast<double>(columns_ - 1) * spacing_;
}

double TriangularLattice::site_area() const
{
  return half_sqrt3 * spacing_ * spacing_;
}

bool TriangularLattice::is_site(std::size_t place) const
{
  const std::size_t padded_row = place / stride();
  const std::size_t padded_column = place % stride();
  if (padded_row < margin || padded_row >= rows_ + margin || padded_column < margin)
    return false;
  return padded_column - margin < sites_in_row(padded_row - margin);
}

Eigen::Vector2d TriangularLattice::reference(std::size_t place) const
{
  const auto row = static_cast<std::ptrdiff_t>(place / stride()) - static_cast<std::ptrdiff_t>(margin);
  const auto column = static_cast<std::ptrdiff_t>(place % stride()) - static_cast<std::ptrdiff_t>(margin);
  const double along = static_cast<double>(column) + (row % 2 != 0 ? 0.5 : 0.);
  const double across = static_cast<double>(row);
  // Centring before scaling keeps mirror sites at exactly opposite y.
  if (orientation_ == Orientation::rows_along_crack)
    return from_row_frame(along, across - 0.5 * static_cast<double>(rows_ - 1));
  return from_row_frame(along - 0.5 * static_cast<double>(columns_ - 1), across);
}

std::ptrdiff_t TriangularLattice::shift(std::size_t kind, std::size_t row) const
{
  const auto up = static_cast<std::ptrdiff_t>(stride());
  const auto parity = static_cast<std::ptrdiff_t>(row % 2);
  const std::array<std::ptrdiff_t, n_bond_kinds> shifts{
    {1, up + parity, up + parity - 1, up + parity + 1, up + parity - 2, 2 * up}};
  return shifts[kind];
}

Eigen::Vector2d TriangularLattice::bond_vector(std::size_t kind) const
{
  return from_row_frame(bond_directions[kind].along, bond_directions[kind].across);
}

double TriangularLattice::rest_length(std::size_t kind) const
{
  return is_nearest(kind) ? spacing_ : 2. * half_sqrt3 * spacing_;
}

Eigen::Vector2d TriangularLattice::from_row_frame(double along, double across) const
{
  const double u = along * spacing_;
  const double v = across * half_sqrt3 * spacing_;
  return orientation_ == Orientation::rows_along_crack ? Eigen::Vector2d(u, v) : Eigen::Vector2d(v, u);
}

} // namespace lattice
