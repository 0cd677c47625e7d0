#include "verification/bridge/anisotropy.h"

#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

namespace latcon::bridge
{

Eigen::Matrix2d lattice_rotation(int k)
{
  return Eigen::Rotation2Dd(M_PI / 3. * k / n_lattice_rotations).toRotationMatrix();
}

RotationMean rotation_mean(const Eigen::MatrixXd &values)
{
  constexpr int n = n_lattice_rotations;
  if (values.cols() != n)
    throw std::invalid_argument("a mean over rotations of the lattice needs one column of values per rotation");
  const Eigen::VectorXd mean = values.rowwise().mean();
  const Eigen::MatrixXd rest = values.colwise() - mean; // the harmonics would be lost in the round-off of the mean
  double bound = 0.;
  for (int j = 1; j < n; ++j)
  {
    Eigen::VectorXcd harmonic = Eigen::VectorXcd::Zero(rest.rows());
    for (int k = 0; k < n; ++k)
      harmonic += std::polar(1. / n, -2. * M_PI * (j * k % n) / n) * rest.col(k);
    bound += harmonic.norm();
  }
  return {mean, bound};
}

} // namespace latcon::bridge
