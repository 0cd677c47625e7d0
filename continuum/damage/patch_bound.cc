#include "continuum/damage/patch_bound.h"

#include <algorithm>

#include "support/dense.h"

namespace latcon::continuum
{
namespace
{
// Integral of Grad phi_a . D Grad phi_b over a cell with 2 x 2 Gauss points, D = (XX, XY, YY).
Eigen::Matrix4d cell_matrix(const NodeGrid &grid, const std::array<double, 3> &D)
{
  constexpr double gauss[2] = {0.21132486540518711775, 0.78867513459481288225};
  const double rx = 1. / grid.size_x, ry = 1. / grid.size_y;
  Eigen::Matrix4d K = Eigen::Matrix4d::Zero();
  for (const double s : gauss)
    for (const double t : gauss)
    {
      const Eigen::Vector4d X(-(1. - t) * rx, (1. - t) * rx, -t * rx, t * rx);
      const Eigen::Vector4d Y(-(1. - s) * ry, -s * ry, (1. - s) * ry, s * ry);
      K += 0.25 * grid.area() *
           (D[0] * X * X.transpose() + D[1] * (X * Y.transpose() + Y * X.transpose()) + D[2] * Y * Y.transpose());
    }
  return K;
}

} // namespace

double patch_bound(const NodeGrid &grid, const std::array<double, 3> &conductivity,
                   const std::vector<GradientForces::PatchTerm> &terms, const double density, const double length)
{
  const Eigen::Matrix4d K_cell = cell_matrix(grid, conductivity);
  const Eigen::Matrix4d M_cell =
    density * (0.25 * grid.area() * Eigen::Matrix4d::Identity() + length * length * cell_matrix(grid, {1., 0., 1.}));
  // Edge nodes have the cells without gradient energy.
  double bound = support::largest_eigenvalue(K_cell, M_cell);
  if (!terms.empty())
  {
    // A node with its share, a quarter, of the four cells around it.
    using Matrix = Eigen::Matrix<double, 9, 9>;
    Matrix K = Matrix::Zero(), M = Matrix::Zero();
    for (const int lower : {0, 1, 3, 4})
    {
      const int corner[4] = {lower, lower + 1, lower + 3, lower + 4};
      for (int p = 0; p < 4; ++p)
        for (int q = 0; q < 4; ++q)
        {
          K(corner[p], corner[q]) += 0.25 * K_cell(p, q);
          M(corner[p], corner[q]) += 0.25 * M_cell(p, q);
        }
    }
    for (const GradientForces::PatchTerm &term : terms)
    {
      const Eigen::Map<const Eigen::Matrix<double, 9, 1>> S(term.S.data());
      K += grid.area() * term.stiffness * S * S.transpose();
    }
    bound = std::max(bound, support::largest_eigenvalue(K, M));
  }
  return bound;
}
} // namespace latcon::continuum
