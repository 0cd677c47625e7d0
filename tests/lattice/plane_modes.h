#pragma once

#include <complex>
#include <vector>

#include <Eigen/Eigenvalues>

#include "tests/lattice/sheets.h"

/// Damped plane waves about a homogeneous state, by Bloch's analysis (theory-comparison.md, eq. (W.1)).
namespace plane_modes
{

/// Modes of one wave vector: y = (u, v) = Re (modes.col(i) exp(i K.X + rates(i) t)).
struct PlaneModes
{
  Eigen::Vector4cd rates; ///< [1/s]
  Eigen::Matrix4cd modes;
};

/// @param K referential [1/m]
inline PlaneModes of(const latcon::lattice::TriangularLattice &sheet, const latcon::lattice::Material &material,
                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
  system.topRightCorner<2, 2>().setIdentity();
  for (std::size_t kind = 0; kind < latcon::lattice::n_bond_kinds; ++kind)
    if (const latcon::lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d R = sheet.bond_vector(kind), r = F * R;
      const double stretch = r.norm() / R.norm(), sine = std::sin(0.5 * K.dot(R));
      const Eigen::Matrix2d along = r * r.transpose() / r.squaredNorm();
      const double weight = 4. * sine * sine * cross_section(*shell, sheet) / (R.norm() * site_mass(material, sheet));
      system.bottomLeftCorner<2, 2>() -=
        weight * (stiffness(shell->law, stretch) * along +
                  force(shell->law, stretch) / stretch * (Eigen::Matrix2d::Identity() - along));
      system.bottomRightCorner<2, 2>() -= weight * shell->viscosity * along;
    }
  // In units of which velocities are as large as displacements, for the sake of the eigenvalue solver.
  const double rate = 1e4;
  const Eigen::Vector4d scale(1., 1., rate, rate);
  const Eigen::EigenSolver<Eigen::Matrix4d> solver(scale.cwiseInverse().asDiagonal() * system * scale.asDiagonal());
  return {solver.eigenvalues(), scale.asDiagonal() * solver.eigenvectors()};
}

/// Rates of n by n wave vectors that fill the first Brillouin zone and more, [1/s].
inline std::vector<std::complex<double>> rates(const latcon::lattice::TriangularLattice &sheet,
                                               const latcon::lattice::Material &material, const Eigen::Matrix2d &F,
                                               int n = 48)
{
  std::vector<std::complex<double>> all;
  for (int i = -n; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      if (i != 0 || j != 0)
      {
        // 4 pi / 3 d and 2 pi / sqrt3 d are the corners and the middles of the edges of the zone.
        const Eigen::Vector2d K(4. * M_PI / 3. * i / n, 2. * M_PI / std::sqrt(3.) * j / n);
        const PlaneModes modes = of(sheet, material, F, K / sheet.spacing());
        for (Eigen::Index k = 0; k < 4; ++k)
          all.push_back(modes.rates(k));
      }
  return all;
}

} // namespace plane_modes
