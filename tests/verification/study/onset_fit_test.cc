// Power law above an onset: known exponents recovered with the stated confidence, and data that determine nothing.
#include "verification/study/onset_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/verification/study/normal_numbers.h"

namespace onset_fit_test
{

using namespace latcon;
using namespace study;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Means of three seeds that scatter by `deviation` about 2 (p - 1)^exponent.
std::vector<OnsetPoint> drawn(std::mt19937_64 &generator, double exponent, double deviation,
                              const std::vector<double> &parameters = {1.75, 1.05, 1.1, 1.2, 1.35, 1.5, 1.02})
{
  std::vector<OnsetPoint> points;
  for (const double parameter : parameters)
  {
    std::vector<double> values;
    SampleMean sample{0., 3};
    for (std::size_t i = 0; i < sample.n; ++i)
    {
      values.push_back(2. * std::pow(parameter - 1., exponent) + deviation * standard_normal(generator));
      sample.mean += values.back() / 3.;
    }
    for (const double value : values)
      sample.variance += std::pow(value - sample.mean, 2) / 2.;
    points.push_back({parameter, sample});
  }
  return points;
}

bool covers(const Interval &interval, double value)
{
  return interval.low <= value && value <= interval.high;
}

TEST(OnsetFit, RecoversAnExactPowerLaw)
{
  for (const double exponent : {0.25, 0.5, 1.})
  {
    std::vector<OnsetPoint> points;
    for (const double parameter : {-2.9, -2.5, -2., -1., 0.})
      points.push_back({parameter, {7. * std::pow(parameter + 3., exponent), 2, 1e-12}});
    const OnsetFit fit = fit_onset(points).value();
    // The scatter of 1e-6 moves exponent and onset by about as much; no error of the curve is larger.
    EXPECT_NEAR(fit.exponent.value, exponent, 1e-5);
    EXPECT_NEAR(fit.onset.value, -3., 1e-5);
    EXPECT_NEAR(fit.prefactor, 7., 1e-4);
    EXPECT_LT(fit.exponent.high - fit.exponent.low, 1e-4);
    EXPECT_TRUE(covers(fit.exponent, exponent));
    EXPECT_TRUE(covers(fit.onset, -3.));
    EXPECT_TRUE(fit.is_bounded());
  }
}

TEST(OnsetFit, IntervalsHaveTheirConfidence)
{
  constexpr int n_draws = 150;
  for (const double exponent : {0.5, 1.})
  {
    std::mt19937_64 generator(1883);
    int with_exponent = 0, with_onset = 0, good = 0;
    double sum = 0.;
    for (int draw = 0; draw < n_draws; ++draw)
    {
      const OnsetFit fit = fit_onset(drawn(generator, exponent, 0.01)).value();
      with_exponent += covers(fit.exponent, exponent);
      with_onset += covers(fit.onset, 1.);
      good += fit.p_fit > significance;
      sum += fit.exponent.value;
      EXPECT_LT(fit.exponent.low, fit.exponent.value);
      EXPECT_LT(fit.exponent.value, fit.exponent.high);
      EXPECT_LT(fit.onset.low, fit.onset.value);
    }
    // At least 95 %, less four standard deviations of 150 draws (7 %); not all, or the intervals would be useless.
    for (const int count : {with_exponent, with_onset, good})
    {
      EXPECT_GT(count, 0.88 * n_draws) << exponent;
      EXPECT_LT(count, n_draws) << exponent;
    }
    EXPECT_NEAR(sum / n_draws, exponent, 0.01);
  }
}

TEST(OnsetFit, DoesNotDependOnUnitsOrOrder)
{
  std::mt19937_64 generator(7);
  std::vector<OnsetPoint> points = drawn(generator, 0.5, 0.03);
  const OnsetFit fit = fit_onset(points).value();
  std::reverse(points.begin(), points.end());
  for (OnsetPoint &point : points)
  {
    point.parameter *= 1e-3;
    point.mean.mean *= 1e-4;
    point.mean.variance *= 1e-8;
  }
  const OnsetFit scaled = fit_onset(points).value();
  EXPECT_NEAR(scaled.exponent.value, fit.exponent.value, 1e-6);
  EXPECT_NEAR(scaled.exponent.low, fit.exponent.low, 1e-6);
  EXPECT_NEAR(scaled.onset.value, 1e-3 * fit.onset.value, 1e-9);
  EXPECT_NEAR(scaled.prefactor, 1e-4 * fit.prefactor * std::pow(1e3, fit.exponent.value), 1e-6 * scaled.prefactor);
}

// Far above an onset any exponent fits.
TEST(OnsetFit, FarFromTheOnsetTheExponentIsUnbounded)
{
  std::mt19937_64 generator(11);
  const OnsetFit fit = fit_onset(drawn(generator, 0.5, 0.1, {4., 4.1, 4.2, 4.3, 4.4, 4.5})).value();
  EXPECT_FALSE(fit.is_bounded());
}

TEST(OnsetFit, CurvesThatDoNotFitHaveWiderIntervals)
{
  std::mt19937_64 generator(13);
  std::vector<OnsetPoint> points = drawn(generator, 0.5, 0.01);
  const OnsetFit fit = fit_onset(points).value();
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].mean.mean += i % 2 == 0 ? 0.1 : -0.1; // ten times the scatter
  const OnsetFit bad = fit_onset(points).value();
  EXPECT_LT(bad.p_fit, 1e-4);
  EXPECT_GT(bad.exponent.high - bad.exponent.low, 5. * (fit.exponent.high - fit.exponent.low));
}

// Runs scatter about the curve three times as far as seeds about their run.
TEST(OnsetFit, IntervalsHaveTheirConfidenceForRunsThatScatter)
{
  constexpr int n_draws = 400;
  std::mt19937_64 generator(1931);
  int with_exponent = 0;
  for (int draw = 0; draw < n_draws; ++draw)
  {
    std::vector<OnsetPoint> points = drawn(generator, 0.5, 0.01, {1.02, 1.1, 1.25, 1.5, 1.75});
    for (OnsetPoint &point : points)
      point.mean.mean += 0.03 * standard_normal(generator);
    with_exponent += covers(fit_onset(points).value().exponent, 0.5);
  }
  EXPECT_GT(with_exponent, 0.906 * n_draws); // 95 %, less four standard deviations of 400 draws
}

TEST(OnsetFit, DataThatDetermineNothingGiveNone)
{
  std::mt19937_64 generator(17);
  const std::vector<OnsetPoint> points = drawn(generator, 0.5, 0.03);
  ASSERT_TRUE(fit_onset(points));
  EXPECT_FALSE(fit_onset({}));
  EXPECT_FALSE(fit_onset({points.begin(), points.begin() + 4}));
  const auto after = [&points](const auto &change)
  {
    std::vector<OnsetPoint> changed = points;
    change(changed);
    return fit_onset(changed).has_value();
  };
  EXPECT_FALSE(after([](auto &p) { p[2].mean.mean = not_a_number; }));
  EXPECT_FALSE(after([](auto &p) { p[2].parameter = not_a_number; }));
  EXPECT_FALSE(after([](auto &p) { p[2].mean.variance = not_a_number; }));
  EXPECT_FALSE(after([](auto &p) { p[2].mean.mean = 0.; }));
  EXPECT_FALSE(after([](auto &p) { p[2].parameter = p[3].parameter; }));
  EXPECT_FALSE(after(
    [](auto &p)
    {
      for (OnsetPoint &point : p)
        point.mean.variance = 0.;
    }));
  EXPECT_FALSE(after(
    [](auto &p)
    {
      for (OnsetPoint &point : p)
        point.mean.n = 1;
    }));
}

} // namespace onset_fit_test
