#include "support/dense.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

namespace latcon::support::dense_test
{

TEST(Dense, ModesOfSymmetricMatrices)
{
  Eigen::Matrix3d K;
  K << 2., -1., 0., -1., 2., -1., 0., -1., 2.;
  const Eigen::Vector3d expected(2. - std::sqrt(2.), 2., 2. + std::sqrt(2.));
  const SymmetricModes modes = symmetric_modes(K);
  EXPECT_LT((modes.values - expected).norm(), 1e-14);
  EXPECT_LT((K * modes.vectors - modes.vectors * expected.asDiagonal()).norm(), 1e-14);
  EXPECT_LT((symmetric_eigenvalues(K) - expected).norm(), 1e-14);

  const Eigen::Matrix3d M = Eigen::Vector3d(1., 4., 9.).asDiagonal();
  const SymmetricModes general = symmetric_modes(K, M);
  EXPECT_LT((K * general.vectors - M * general.vectors * general.values.asDiagonal()).norm(), 1e-14);
  EXPECT_LT((general.vectors.transpose() * M * general.vectors - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(Dense, ModesOfADampedOscillator)
{
  const double w = 3., g = 0.5; // u'' + 2 g u' + w^2 u = 0
  Eigen::Matrix2d B;
  B << 0., 1., -w * w, -2. * g;
  const ComplexModes modes = complex_modes(B);
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_NEAR(modes.values[i].real(), -g, 1e-14);
    EXPECT_NEAR(std::abs(modes.values[i].imag()), std::sqrt(w * w - g * g), 1e-14);
    EXPECT_LT((B * modes.vectors.col(i) - modes.values[i] * modes.vectors.col(i)).norm(), 1e-14);
  }
}

TEST(Dense, FitsALineAndStretches)
{
  Eigen::MatrixXd A(4, 2);
  A << 1., 0., 1., 1., 1., 2., 1., 3.;
  const Eigen::Vector4d b(1., 2., 2., 4.);
  const Eigen::VectorXd x = least_squares(A, b);
  EXPECT_NEAR(x[0], 0.9, 1e-14);
  EXPECT_NEAR(x[1], 0.9, 1e-14);
  double log_gram = 0.;
  EXPECT_EQ(least_squares(A, b, &log_gram), x);
  EXPECT_NEAR(log_gram, std::log(20.), 1e-14); // 4 14 - 6 6
  EXPECT_LT((solve_positive(A.transpose() * A, A.transpose() * b) - x).norm(), 1e-14);

  Eigen::Matrix2d F; // a rotation after stretches of 3 and 2
  F << 0., -2., 3., 0.;
  EXPECT_LT((singular_values(F) - Eigen::Vector2d(3., 2.)).norm(), 1e-14);
}

TEST(Dense, InvertsWhatHasFullRank)
{
  Eigen::MatrixXd A(3, 2);
  A << 1., 0., 1., 1., 1., 2.;
  const std::optional<Eigen::MatrixXd> inverse = left_inverse(A, 1e-6);
  ASSERT_TRUE(inverse);
  EXPECT_LT((*inverse * A - Eigen::Matrix2d::Identity()).norm(), 1e-14);
  A.col(1) = A.col(0) * 2. + Eigen::Vector3d(0., 0., 1e-8);
  EXPECT_FALSE(left_inverse(A, 1e-6));
  EXPECT_TRUE(left_inverse(A, 1e-10));

  // The point (1, 2) of the line x + 2 y = 5 is nearest to the origin.
  const Eigen::VectorXd x = shortest_least_squares(Eigen::RowVector2d(1., 2.), Eigen::VectorXd::Constant(1, 5.));
  EXPECT_LT((x - Eigen::Vector2d(1., 2.)).norm(), 1e-14);
}

} // namespace latcon::support::dense_test
