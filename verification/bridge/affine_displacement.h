/// Fields as functions of the finite elements.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <deal.II/base/auto_derivative_function.h>

#include "continuum/meshes.h"
#include "continuum/static_solver.h"
#include "verification/input/continuum_case.h"

namespace latcon::bridge
{

/// Affine displacement field u(X) = (F - I) X [m].
class AffineDisplacement : public dealii::Function<2>
{
public:
  explicit AffineDisplacement(Eigen::Matrix2d F) : dealii::Function<2>(2), F_(std::move(F)) {}

  double value(const dealii::Point<2> &X, unsigned int i) const override
  {
    return F_(i, 0) * X[0] + F_(i, 1) * X[1] - X[i];
  }

private:
  Eigen::Matrix2d F_;
};

/// Vector field of a case as a function of the finite elements. Gradients are differences of fourth order: their step
/// balances the error of the formula against round-off.
class FieldFunction : public dealii::AutoDerivativeFunction<2>
{
public:
  /// @param extent length of the sheet [m], the scale on which the field varies @param F of components "loading"
  FieldFunction(const input::FieldCase &field, double extent, const Eigen::Matrix2d &F = Eigen::Matrix2d::Identity())
    : dealii::AutoDerivativeFunction<2>(1e-3 * extent, 2), field_(field.field(F))
  {
    set_formula(dealii::AutoDerivativeFunction<2>::FourthOrder);
  }

  /// @throws InputError with the position if the value is not finite
  double value(const dealii::Point<2> &X, unsigned int component) const override
  {
    return field_(component, X[0], X[1]);
  }

private:
  std::function<double(unsigned int, double, double)> field_;
};

/// Returns conditions that prescribe the displacement (F - I) X on all four edges of a rectangle.
inline std::vector<continuum::BoundaryField> affine_boundary(const Eigen::Matrix2d &F)
{
  const auto displacement = std::make_shared<AffineDisplacement>(F);
  std::vector<continuum::BoundaryField> conditions;
  for (const auto edge : {continuum::edge::left, continuum::edge::right, continuum::edge::bottom, continuum::edge::top})
    conditions.push_back({edge, displacement});
  return conditions;
}

} // namespace latcon::bridge
