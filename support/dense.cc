#include "support/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace latcon::support
{
namespace
{
using Symmetric = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
using QR = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
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
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

ComplexModes complex_modes(const Eigen::Ref<const Eigen::MatrixXd> &matrix)
{
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd> &A, const Eigen::Ref<const Eigen::VectorXd> &b,
                              double *log_gram)
{
  const QR qr(A);
  if (log_gram != nullptr)
    *log_gram = 2. * qr.matrixQR().diagonal().array().abs().log().sum();
  return qr.solve(b);
}

std::optional<Eigen::MatrixXd> left_inverse(const Eigen::Ref<const Eigen::MatrixXd> &A, double threshold)
{
  QR qr(A);
  qr.setThreshold(threshold);
  if (qr.rank() < A.cols())
    return std::nullopt;
  return qr.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
}

Eigen::VectorXd shortest_least_squares(const Eigen::Ref<const Eigen::MatrixXd> &A,
                                       const Eigen::Ref<const Eigen::VectorXd> &b)
{
  return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
}

Eigen::MatrixXd solve_positive(const Eigen::Ref<const Eigen::MatrixXd> &A, const Eigen::Ref<const Eigen::MatrixXd> &B)
{
  return A.ldlt().solve(B);
}

Eigen::Vector2d singular_values(const Eigen::Matrix2d &matrix)
{
  return Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>(matrix).singularValues();
}

} // namespace latcon::support
