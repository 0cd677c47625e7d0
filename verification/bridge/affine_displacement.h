#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <deal.II/base/function.h>

#include "continuum/rectangle.h"
#include "continuum/static_solver.h"

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

/// Returns conditions that prescribe the displacement (F - I) X on all four edges of a rectangle.
inline std::vector<continuum::PrescribedDisplacement> affine_boundary(const Eigen::Matrix2d &F)
{
  const auto displacement = std::make_shared<AffineDisplacement>(F);
  std::vector<continuum::PrescribedDisplacement> conditions;
  for (const auto edge : {continuum::edge::left, continuum::edge::right, continuum::edge::bottom, continuum::edge::top})
    conditions.push_back({edge, displacement});
  return conditions;
}

} // namespace latcon::bridge
