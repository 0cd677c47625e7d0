// Statistics of crack paths, compared with dense linear algebra.

#include "verification/analysis/path_fit.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace path_fit_test
{

using namespace latcon;

constexpr double pi = 3.14159265358979323846;

TEST(CorrelatedNoise, LikelihoodIsThatOfTheDenseMatrix)
{
  // Compares the filter with the definition -1/2 [(n - p)(ln 2 pi v + 1) + ln det C + ln det(D^T C^-1 D)] at the
  // estimated noise.
  const Eigen::Index n = 15;
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd s(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i)
  {
    s(i) = (i == 0 ? 0. : s(i - 1)) + 0.2 + std::abs(normal(generator));
    y(i) = 0.9 * (i == 0 ? 0. : y(i - 1)) + normal(generator);
  }
  Eigen::MatrixXd line(n, 2);
  line << Eigen::VectorXd::Ones(n), s;
  const analysis::NoiseFit fit = analysis::fit_noise(s, line, y, 1e-9);
  ASSERT_GT(fit.noise.correlated_fraction, 0.) << "the filter would not be tested";
  const Eigen::MatrixXd C = analysis::covariance(fit.noise, s);
  const Eigen::MatrixXd information = line.transpose() * C.inverse() * line;
  const Eigen::VectorXd residual = y - line * information.inverse() * line.transpose() * C.inverse() * y;
  const double freedom = static_cast<double>(n - 2);
  EXPECT_NEAR(residual.dot(C.inverse() * residual), freedom, 1e-9 * freedom); // the variance is optimal
  const double expected =
    -0.5 * (freedom * (std::log(2. * pi) + 1.) + std::log(C.determinant()) + std::log(information.determinant()));
  EXPECT_NEAR(fit.log_evidence, expected, 1e-9 * std::abs(expected));
}

TEST(CorrelatedNoise, RefusesTooFewOrUnorderedSamples)
{
  const Eigen::VectorXd s = Eigen::Vector3d(0., 1., 2.);
  EXPECT_THROW(analysis::fit_noise(s, Eigen::MatrixXd::Ones(3, 3), s, 1e-3), std::invalid_argument);
  EXPECT_THROW(analysis::fit_noise(Eigen::Vector3d(0., 1., 1.), Eigen::MatrixXd::Ones(3, 1), s, 1e-3),
               std::invalid_argument);
}

} // namespace path_fit_test
