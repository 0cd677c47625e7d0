#pragma once

#include <optional>

#include <Eigen/Core>

/// Decompositions of small dense matrices, without units. Every source that instantiates one of Eigen's takes seconds
/// to compile, and more for each fixed size.
namespace latcon::support
{

/// Eigenvalues in ascending order and their eigenvectors in columns.
struct SymmetricModes
{
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Eigenvalues, in no order, and their eigenvectors in columns.
struct ComplexModes
{
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// Eigenvalues and orthonormal eigenvectors of a symmetric matrix, of which the lower triangle is read. All of its
/// entries must be finite.
SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// Eigenvalues of a symmetric matrix alone, in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// Solutions of K v = value M v with symmetric K and positive definite M; v^T M v = 1.
SymmetricModes symmetric_modes(const Eigen::Ref<const Eigen::MatrixXd> &K, const Eigen::Ref<const Eigen::MatrixXd> &M);

/// Eigenvalues and eigenvectors of length 1 of any square matrix with finite entries.
ComplexModes complex_modes(const Eigen::Ref<const Eigen::MatrixXd> &matrix);

/// Vector x with the smallest |A x - b|, by Householder reflections with pivots.
/// @param log_gram set to log det(A^T A) unless null
Eigen::VectorXd least_squares(const Eigen::Ref<const Eigen::MatrixXd> &A, const Eigen::Ref<const Eigen::VectorXd> &b,
                              double *log_gram = nullptr);

/// Matrix X of which A X b is, for every b, nearest to b; none if a column of A is a sum of others but for the fraction
/// `threshold` of the largest.
std::optional<Eigen::MatrixXd> left_inverse(const Eigen::Ref<const Eigen::MatrixXd> &A, double threshold);

/// Shortest of the vectors x with the smallest |A x - b|.
Eigen::VectorXd shortest_least_squares(const Eigen::Ref<const Eigen::MatrixXd> &A,
                                       const Eigen::Ref<const Eigen::VectorXd> &b);

/// Matrix X of A X = B with symmetric positive definite A.
Eigen::MatrixXd solve_positive(const Eigen::Ref<const Eigen::MatrixXd> &A, const Eigen::Ref<const Eigen::MatrixXd> &B);

/// Singular values in descending order: of a deformation gradient, the principal stretches.
Eigen::Vector2d singular_values(const Eigen::Matrix2d &matrix);

} // namespace latcon::support
