#include "verification/claims/wave_sheet.h"

#include <cmath>

#include <deal.II/numerics/vector_tools_interpolate.h>

namespace latcon::claims
{

CosineWave::CosineWave(const Eigen::Vector2d &K, const Eigen::Vector2d &p, double phase)
  : dealii::Function<2>(2), K_(K), p_(p), phase_(phase)
{
}

double CosineWave::value(const dealii::Point<2> &X, unsigned int i) const
{
  return p_[i] * std::cos(K_.x() * X[0] + K_.y() * X[1] - phase_);
}

continuum::Sheet::Vector interpolated(const continuum::Sheet &sheet, const dealii::Function<2> &field)
{
  continuum::Sheet::Vector nodal = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), field, nodal);
  return nodal;
}

continuum::Rectangle one_wavelength(const Eigen::Vector2d &K, unsigned int cells)
{
  const bool along_x = std::abs(K.x()) > 1e-9 * K.norm(), along_y = std::abs(K.y()) > 1e-9 * K.norm();
  const double cell = 2. * M_PI / (K.norm() * cells);
  continuum::Rectangle rectangle{2. * cell, 2. * cell, 2, 2, true, true};
  if (along_x)
  {
    rectangle.length = 2. * M_PI / std::abs(K.x());
    rectangle.cells_x = cells;
  }
  if (along_y)
  {
    rectangle.height = 2. * M_PI / std::abs(K.y());
    rectangle.cells_y = cells;
  }
  return rectangle;
}

continuum::BoundaryConditions periodic_edges()
{
  continuum::BoundaryConditions conditions;
  conditions.periodic = {{continuum::edge::left, continuum::edge::right, 0},
                         {continuum::edge::bottom, continuum::edge::top, 1}};
  return conditions;
}

} // namespace latcon::claims
