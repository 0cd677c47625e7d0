#pragma once

#include <limits>

#include "lattice/simulation.h"

/// Sheets that several tests share.
namespace sheets
{

inline constexpr double spacing = 0.625e-3;
inline constexpr double unbreakable = std::numeric_limits<double>::infinity();

/// The rubber of the source paper's Fig. 1; viscosity of the nearest neighbours in Pa s, three times that for the next.
inline lattice::Material rubber(double viscosity = 65.625)
{
  const lattice::MooneyRivlinBond bond{1e5, 1.5e5};
  const double area_factor = 2. / 3.;
  return {944., {bond, area_factor, viscosity}, lattice::Shell{bond, area_factor, 3. * viscosity}};
}

inline lattice::Material nearest_only(double viscosity = 65.625)
{
  lattice::Material material = rubber(viscosity);
  material.next_nearest.reset();
  return material;
}

inline Eigen::Matrix2d stretched(double x, double y)
{
  return Eigen::Vector2d(x, y).asDiagonal();
}

/// A sheet of about n by n sites.
inline lattice::TriangularLattice square(double n,
                                         lattice::Orientation orientation = lattice::Orientation::rows_along_crack)
{
  return {spacing, n * spacing, n * spacing, orientation};
}

/// The n places in the middle row from a given column on; a seed crack.
inline std::vector<std::size_t> middle_row(const lattice::TriangularLattice &sheet, std::size_t column, std::size_t n)
{
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < n; ++i)
    places.push_back(sheet.index(sheet.rows() / 2, column + i));
  return places;
}

} // namespace sheets
