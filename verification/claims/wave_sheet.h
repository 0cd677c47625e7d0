/// Periodic sheets of finite elements one wavelength long.
#pragma once

#include <Eigen/Core>
#include <deal.II/base/function.h>

#include "continuum/conditions.h"
#include "continuum/rectangle.h"
#include "continuum/sheet.h"

namespace latcon::claims
{

/// Displacement p cos(K.X - phase) [m].
class CosineWave : public dealii::Function<2>
{
public:
  /// @param K referential wave vector [1/m] @param p amplitude [m]
  CosineWave(const Eigen::Vector2d &K, const Eigen::Vector2d &p, double phase = 0.);

  double value(const dealii::Point<2> &X, unsigned int i) const override;

private:
  Eigen::Vector2d K_, p_;
  double phase_;
};

/// Returns the nodal values of a field, without ghost entries. Collective.
continuum::Sheet::Vector interpolated(const continuum::Sheet &sheet, const dealii::Function<2> &field);

/// Returns a periodic rectangle with `cells` per wavelength along each direction in which the wave K varies, and two
/// across where it does not.
continuum::Rectangle one_wavelength(const Eigen::Vector2d &K, unsigned int cells);

/// Returns the conditions at its edges.
continuum::BoundaryConditions periodic_edges();

} // namespace latcon::claims
