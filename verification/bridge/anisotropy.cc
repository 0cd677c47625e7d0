#include "verification/bridge/anisotropy.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "verification/bridge/plane_waves.h"

namespace latcon::bridge
{

namespace
{

// The bound is that of the harmonics from number `first` on.
RotationMean mean_of_period(const Eigen::MatrixXd &values, int n, int first)
{
  if (values.cols() != n)
    throw std::invalid_argument("a mean over a period needs one column of values per rotation or direction");
  const Eigen::VectorXd mean = values.rowwise().mean();
  const Eigen::MatrixXd rest = values.colwise() - mean; // the harmonics would be lost in the round-off of the mean
  double bound = 0.;
  for (int j = first; j <= n - first; ++j)
  {
    Eigen::VectorXcd harmonic = Eigen::VectorXcd::Zero(rest.rows());
    for (int k = 0; k < n; ++k)
      harmonic += std::polar(1. / n, -2. * M_PI * (j * k % n) / n) * rest.col(k);
    bound += harmonic.norm();
  }
  return {mean, bound};
}

} // namespace

Eigen::Matrix2d lattice_rotation(int k)
{
  return Eigen::Rotation2Dd(M_PI / 3. * k / n_lattice_rotations).toRotationMatrix();
}

RotationMean rotation_mean(const Eigen::MatrixXd &values)
{
  return mean_of_period(values, n_lattice_rotations, 1);
}

Eigen::MatrixXd rotated_bloch_stiffness(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                        const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  Eigen::MatrixXd matrices(4, n_lattice_rotations);
  for (int k = 0; k < n_lattice_rotations; ++k)
  {
    const Eigen::Matrix2d R = lattice_rotation(k);
    matrices.col(k) = bloch_matrices(lattice, material, F * R, R.transpose() * K).stiffness.reshaped();
  }
  return matrices;
}

Eigen::Vector2d bond_direction(int k)
{
  const double angle = M_PI * k / n_bond_directions;
  return {std::cos(angle), std::sin(angle)};
}

RotationMean direction_mean(const Eigen::MatrixXd &values)
{
  return mean_of_period(values, n_bond_directions, 3);
}

} // namespace latcon::bridge
