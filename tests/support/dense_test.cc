#include "support/dense.h"

#include <cmath>

#include <gtest/gtest.h>

namespace latcon::support::dense_test
{

TEST(Dense, FitsALine)
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
