// Statistics of crack paths, compared with dense linear algebra, textbook formulas and hand calculations.

#include "verification/analysis/path_fit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace path_fit_test
{

using namespace latcon;

constexpr double pi = 3.14159265358979323846;

// -------------------------------------------------------------------------------------------------------------

TEST(CorrelatedNoise, IndependentNoiseGivesTheTextbookCovariance)
{
  // sigma^2 (D^T D)^-1 for a straight line: variance of the mean sigma^2 / n, of the slope sigma^2 / sum of s^2.
  Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(21, -1., 1.);
  Eigen::MatrixXd line(21, 2);
  line << Eigen::VectorXd::Ones(21), s;
  const Eigen::MatrixXd covariance = analysis::least_squares_covariance({4., 0., 1.}, s, line);
  EXPECT_NEAR(covariance(0, 0), 4. / 21., 1e-12);
  EXPECT_NEAR(covariance(1, 1), 4. / s.squaredNorm(), 1e-12);
  EXPECT_NEAR(covariance(0, 1), 0., 1e-12);
}

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

TEST(CorrelatedNoise, FindsFractionAndLength)
{
  // 400 samples, f = 0.6, length of 8 samples; the median over 25 seeds is within three grid steps of a factor 1.5.
  std::vector<double> lengths, fractions;
  for (unsigned int seed = 1; seed <= 25; ++seed)
  {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const Eigen::Index n = 400;
    Eigen::VectorXd s(n), y(n);
    double remembered = normal(generator);
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const double kept = std::exp(-1. / 8.);
      remembered = kept * remembered + std::sqrt(1. - kept * kept) * normal(generator);
      s(i) = static_cast<double>(i);
      y(i) = 3. + std::sqrt(0.6) * remembered + std::sqrt(0.4) * normal(generator);
    }
    const analysis::NoiseFit fit = analysis::fit_noise(s, Eigen::MatrixXd::Ones(n, 1), y, 1e-6);
    lengths.push_back(fit.noise.correlation_length);
    fractions.push_back(fit.noise.correlated_fraction);
    EXPECT_NEAR(fit.noise.variance, 1., 0.5);
  }
  std::nth_element(lengths.begin(), lengths.begin() + 12, lengths.end());
  std::nth_element(fractions.begin(), fractions.begin() + 12, fractions.end());
  EXPECT_GT(lengths[12], 8. / 1.6);
  EXPECT_LT(lengths[12], 8. * 1.6);
  EXPECT_NEAR(fractions[12], 0.6, 0.16);
}

TEST(CorrelatedNoise, RefusesTooFewOrUnorderedSamples)
{
  const Eigen::VectorXd s = Eigen::Vector3d(0., 1., 2.);
  EXPECT_THROW(analysis::fit_noise(s, Eigen::MatrixXd::Ones(3, 3), s, 1e-3), std::invalid_argument);
  EXPECT_THROW(analysis::fit_noise(Eigen::Vector3d(0., 1., 1.), Eigen::MatrixXd::Ones(3, 1), s, 1e-3),
               std::invalid_argument);
}

TEST(FitSlope, IsTheLeastSquaresSlope)
{
  // Mean position 1.75: sum of centred positions times samples -1.75 - 0.75 + 0.25 * 4 + 2.25 * 5 = 9.75, of their
  // squares 3.0625 + 0.5625 + 0.0625 + 5.0625 = 8.75.
  const analysis::Measured slope =
    analysis::fit_slope(Eigen::Vector4d(0., 1., 2., 4.), Eigen::Vector4d(1., 1., 4., 5.), 1e-6);
  EXPECT_NEAR(slope.value, 9.75 / 8.75, 1e-12);
  EXPECT_THROW(analysis::fit_slope(Eigen::Vector3d(0., 1., 2.), Eigen::Vector3d(0., 1., 2.), 1e-6),
               std::invalid_argument);
}

} // namespace path_fit_test
