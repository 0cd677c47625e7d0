#include "support/dense.h"

#include <gtest/gtest.h>

namespace latcon::support::dense_test
{

// The line through (0, 1), (1, 2), (2, 2), (3, 4); the point (1, 2) of the line x + 2 y = 5, nearest to the origin.
TEST(Dense, SolvesAndInvertsWhatHasFullRank)
{
  Eigen::MatrixXd A(4, 2);
  A << 1., 0., 1., 1., 1., 2., 1., 3.;
  const Eigen::Vector4d b(1., 2., 2., 4.);
  EXPECT_LT((solve_positive(A.transpose() * A, A.transpose() * b) - Eigen::Vector2d(0.9, 0.9)).norm(), 1e-14);
  EXPECT_TRUE(left_inverse(A, 1e-6));
  A.col(1) = A.col(0) * 2. + Eigen::Vector4d(0., 0., 0., 1e-8);
  EXPECT_FALSE(left_inverse(A, 1e-6));
  EXPECT_TRUE(left_inverse(A, 1e-10));
  const Eigen::VectorXd x = shortest_least_squares(Eigen::RowVector2d(1., 2.), Eigen::VectorXd::Constant(1, 5.));
  EXPECT_LT((x - Eigen::Vector2d(1., 2.)).norm(), 1e-14);
}

} // namespace latcon::support::dense_test
