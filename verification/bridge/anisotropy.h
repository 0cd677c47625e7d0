#pragma once

#include <Eigen/Core>

namespace latcon::bridge
{

/// Rotations of a triangular lattice over which means are taken, equispaced over 60 degrees, after which it coincides
/// with itself. At a deformation of principal stretches l1 >= l2 harmonics beyond, which count as lower ones, are the
/// 96th power of rho = (l1 - l2)/(l1 + l2) in the mean and the 48th in the bound.
constexpr int n_lattice_rotations = 32;

/// Rotation number k in [0, n_lattice_rotations) of the lattice's reference configuration [-]. A bond N becomes R N, so
/// the rotated lattice has the energy W(F R) and the first Piola stress P(F R) R^T of the lattice as it is.
Eigen::Matrix2d lattice_rotation(int k);

/// What a lattice has in common with its rotations, and how far it can be from it.
struct RotationMean
{
  Eigen::VectorXd mean;
  double bound; ///< of the Euclidean distance of any rotation from the mean, in the units of the values
};

/// Mean and bound of (theory-comparison.md, eqs. (H.14) and (H.15)) for the values in the columns of a matrix, which
/// belong to the rotations 0, 1 ... n_lattice_rotations - 1.
RotationMean rotation_mean(const Eigen::MatrixXd &values);

} // namespace latcon::bridge
