#include "support/dense.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace latcon::support
{
namespace
{
using Symmetric = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
using Generalized = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;
} // namespace

SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
{
  const Symmetric solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
{
  return Symmetric(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd> &K, const Eigen::Ref<const Eigen::MatrixXd> &M)
{
  const Generalized solver(K, M);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double largest_eigenvalue(const Eigen::Ref<const Eigen::MatrixXd> &K, const Eigen::Ref<const Eigen::MatrixXd> &M)
{
  return Generalized(K, M, Eigen::EigenvaluesOnly).eigenvalues().tail<1>()(0);
}

ComplexModes complex_modes(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd> &A, const Eigen::Ref<const Eigen::VectorXd> &b)
{
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(A).solve(b);
}

Eigen::Vector2d singular_values(const Eigen::Matrix2d &matrix)
{
  return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
}

} // namespace latcon::support
