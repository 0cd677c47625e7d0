// Tests of means over seeds: known values, and simulated rates of wrong and correct decisions.
#include "verification/study/statistical_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/verification/study/normal_numbers.h"
#include "verification/study/study_table.h"

namespace statistical_tests_test
{

using namespace latcon;
using namespace study;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Draws n normal numbers with a mean and a standard deviation, and returns their sample mean and variance.
SampleMean drawn(std::mt19937_64 &generator, double mean, std::size_t n, double deviation = 1.)
{
  std::vector<double> values;
  double sum = 0.;
  for (std::size_t i = 0; i < n; ++i)
  {
    values.push_back(mean + deviation * standard_normal(generator));
    sum += values.back();
  }
  SampleMean sample{sum / static_cast<double>(n), n};
  for (const double value : values)
    if (n > 1)
      sample.variance += std::pow(value - sample.mean, 2) / static_cast<double>(n - 1);
  return sample;
}

// Upper bound on a measured rate of 5 %, at four standard deviations: exceeded by chance for one of 30,000 correct
// rules.
double above_nominal(std::size_t n_draws)
{
  return significance + 4. * std::sqrt(significance * (1. - significance) / static_cast<double>(n_draws));
}

constexpr std::size_t n_draws = 10000;

// Returns the fraction of draws in which the second sample is found to exceed the first; the true difference is
// `difference` standard deviations.
double share_found(std::size_t n, std::size_t m, double difference, double first_deviation = 1., double floor = 0.)
{
  std::mt19937_64 generator(1947);
  std::size_t found = 0;
  for (std::size_t draw = 0; draw < n_draws; ++draw)
  {
    SampleMean first = drawn(generator, 0., n, first_deviation), second = drawn(generator, difference, m);
    first.min_variance = second.min_variance = floor;
    found += welch_p_value(first, second).value() <= significance;
  }
  return static_cast<double>(found) / n_draws;
}

// Fractions of draws in which means are found to rise, to fall somewhere, and in which the rule `rises` holds.
struct Shares
{
  double rise = 0., fall = 0., holds = 0.;
};

Shares shares_of(const std::vector<double> &means, const std::vector<std::size_t> &n,
                 const std::vector<double> &deviations = {}, double floor = 0.)
{
  std::vector<double> weights(n.begin(), n.end());
  const std::vector<double> levels = level_probabilities(weights);
  std::mt19937_64 generator(1959);
  Shares shares;
  for (std::size_t draw = 0; draw < n_draws; ++draw)
  {
    std::vector<SampleMean> samples;
    for (std::size_t i = 0; i < means.size(); ++i)
    {
      samples.push_back(drawn(generator, means[i], n[i], deviations.empty() ? 1. : deviations[i]));
      samples.back().min_variance = floor;
    }
    const TrendTest test = isotonic_test(samples, levels).value();
    shares.rise += (test.p_rise <= significance ? 1. : 0.) / n_draws;
    shares.fall += (test.p_fall <= significance ? 1. : 0.) / n_draws;
    shares.holds += (test.p_rise <= significance && test.p_fall > significance ? 1. : 0.) / n_draws;
  }
  return shares;
}

// As in the studies: two seeds, and five for the case of Fig. 1.
const std::vector<std::size_t> six_runs{2, 2, 2, 2, 5, 2}, four_runs{2, 2, 2, 5}, three_seeds_each{3, 3, 3, 3, 3, 3};

TEST(Welch, HasTheKnownProbability)
{
  // Student's t of 12.2474 with 4 degrees of freedom; of sqrt 20 with 1.47, rounded down to 1.
  EXPECT_NEAR(welch_p_value({0.021, 3, 1e-6}, {0.031, 3, 1e-6}).value(), 1.2761e-4, 1e-8);
  EXPECT_NEAR(welch_p_value({0., 2, 0.02}, {1., 2, 0.08}).value(), 0.0700243, 1e-7);
  EXPECT_NEAR(welch_p_value({1., 4, 1.}, {1., 4, 2.}).value(), 0.5, 1e-15);
  EXPECT_GT(welch_p_value({1., 4, 1.}, {-1., 4, 2.}).value(), 0.9);
}

TEST(Welch, KnowsNothingWithoutAnEstimateOfTheError)
{
  EXPECT_FALSE(welch_p_value({0., 1}, {1., 5, 0.1}).has_value());
  EXPECT_FALSE(welch_p_value({0., 5, 0.1}, {1., 1}).has_value());
  EXPECT_FALSE(welch_p_value({0., 2, 0.}, {1., 2, 0.}).has_value());
  EXPECT_FALSE(welch_p_value({not_a_number, 2, 1.}, {1., 2, 1.}).has_value());
  EXPECT_TRUE(welch_p_value({0., 2, 0.}, {1., 2, 0.1}).has_value());
}

TEST(Welch, FindsWhatIsNotThereAsOftenAsItSays)
{
  for (const auto &[n, m] : {std::pair(2, 2), std::pair(2, 5), std::pair(3, 5), std::pair(5, 5)})
    EXPECT_LE(share_found(n, m, 0.), above_nominal(n_draws)) << n << " and " << m << " seeds";
  // Worst case of the approximation: two seeds with three times the scatter of five, 6.2 %.
  EXPECT_LE(share_found(2, 5, 0., 3.), 0.062 + above_nominal(n_draws) - significance);
  // The test does find differences: its level is not zero.
  EXPECT_GE(share_found(5, 5, 0.), 0.035);
  // With a floor no test finds more differences.
  for (const double floor : {0.5, 1., 2.})
    EXPECT_LE(share_found(2, 5, 0., 1., floor), share_found(2, 5, 0.));
}

// The power that docs/reference.md states.
TEST(Welch, FindsWhatIsThere)
{
  EXPECT_GE(share_found(5, 5, 2.5), 0.9);
  EXPECT_GE(share_found(2, 5, 10.), 0.9);
  EXPECT_GE(share_found(2, 2, 12.), 0.9);
}

TEST(Holm, AdjustsEachByTheNumberOfThoseThatAreLeft)
{
  const std::vector<double> adjusted = adjust_by_holm({0.04, 0.01, 0.03, not_a_number});
  EXPECT_NEAR(adjusted[1], 0.04, 1e-15);
  EXPECT_NEAR(adjusted[2], 0.09, 1e-15);
  EXPECT_NEAR(adjusted[0], 0.09, 1e-15); // not less than a previous one
  EXPECT_TRUE(std::isnan(adjusted[3]));
  EXPECT_EQ(adjust_by_holm({0.9, 0.8})[0], 1.);
  EXPECT_TRUE(adjust_by_holm({}).empty());
}

// All pairs of six equal runs: at least one pair is found in at most 5 % of cases.
TEST(Holm, NamesAPairThatIsNotThereAsOftenAsItSays)
{
  std::mt19937_64 generator(1979);
  constexpr std::size_t n = 2000;
  std::size_t named = 0;
  for (std::size_t draw = 0; draw < n; ++draw)
  {
    std::vector<SampleMean> samples;
    for (int run = 0; run < 6; ++run)
      samples.push_back(drawn(generator, 0., 3));
    std::vector<double> p_values;
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (std::size_t j = i + 1; j < samples.size(); ++j)
        p_values.push_back(welch_p_value(samples[j], samples[i]).value());
    const std::vector<double> adjusted = adjust_by_holm(p_values);
    named += std::any_of(adjusted.begin(), adjusted.end(), [](double p) { return p <= significance; });
  }
  EXPECT_LE(static_cast<double>(named) / n, above_nominal(n));
}

// Equal weights: Stirling numbers of the first kind over k!. Three: 1/4 + asin(rho) / (2 pi), 1/2, and the rest
// (Bartholomew). Known to 4 standard deviations of the draws.
TEST(LevelProbabilities, AreTheKnownOnes)
{
  const double digits = 4. * std::sqrt(0.25 / 20000.);
  const std::vector<double> four = level_probabilities({1., 1., 1., 1.});
  const double stirling[] = {6., 11., 6., 1.};
  for (std::size_t l = 0; l < 4; ++l)
    EXPECT_NEAR(four[l], stirling[l] / 24., digits);
  const std::vector<double> three = level_probabilities({2., 2., 5.});
  const double rho = -std::sqrt(2. * 5. / ((2. + 2.) * (2. + 5.)));
  EXPECT_NEAR(three[2], 0.25 + std::asin(rho) / (2. * M_PI), digits);
  EXPECT_NEAR(three[1], 0.5, digits);
  EXPECT_NEAR(three[0], 0.25 - std::asin(rho) / (2. * M_PI), digits);
}

// Two runs: half of Fisher's F, that is, one-sided Student's t.
TEST(IsotonicTest, OfTwoRunsIsStudentsTest)
{
  const std::vector<double> levels{0.5, 0.5};
  const TrendTest test = isotonic_test({{0.021, 3, 1e-6}, {0.031, 3, 1e-6}}, levels).value();
  EXPECT_NEAR(test.p_rise, 1.2761e-4, 1e-8);
  EXPECT_EQ(test.p_fall, 1.);
  const TrendTest reversed = isotonic_test({{0.031, 3, 1e-6}, {0.021, 3, 1e-6}}, levels).value();
  EXPECT_EQ(reversed.p_rise, 1.);
  EXPECT_NEAR(reversed.p_fall, 1.2761e-4, 1e-8);
}

TEST(IsotonicTest, KnowsNothingWithoutAnEstimateOfTheError)
{
  EXPECT_FALSE(isotonic_test({{0., 1}, {1., 1}, {2., 1}}).has_value());
  EXPECT_FALSE(isotonic_test({{0., 2, 0.}, {1., 2, 0.}}).has_value());
  EXPECT_FALSE(isotonic_test({{0., 2, not_a_number}, {1., 2, 1.}}).has_value());
  EXPECT_FALSE(isotonic_test({{not_a_number, 2, 1.}, {1., 2, 1.}}).has_value());
  EXPECT_TRUE(isotonic_test({{0., 1}, {1., 1}, {2., 2, 1e-3}}).has_value());
}

TEST(IsotonicTest, FindsWhatIsNotThereAsOftenAsItSays)
{
  for (const auto &n : {six_runs, four_runs, three_seeds_each})
  {
    const Shares flat = shares_of(std::vector<double>(n.size(), 0.), n);
    EXPECT_LE(flat.rise, above_nominal(n_draws)); // wrongly found rise
    EXPECT_LE(flat.fall, above_nominal(n_draws)); // wrongly found fall
    EXPECT_GE(flat.rise, 0.04);                   // the level is not zero
    EXPECT_GE(flat.fall, 0.04);
  }
  // A sequence that rises until it saturates does not fall: the rule rejects it less often than a constant one.
  EXPECT_LE(shares_of({0., 2., 3.5, 4., 4., 4.}, six_runs).fall, above_nominal(n_draws));
  // Scatter of the seeds in proportion to the mean.
  EXPECT_LE(shares_of({10., 15., 18., 20., 20., 20.}, six_runs, {1., 1.5, 1.8, 2., 2., 2.}).fall,
            above_nominal(n_draws));
  // With a floor no test finds more differences.
  const Shares floored = shares_of(std::vector<double>(6, 0.), six_runs, {}, 1.);
  EXPECT_LE(floored.rise, above_nominal(n_draws));
  EXPECT_LE(floored.fall, above_nominal(n_draws));
}

// The power that docs/reference.md states.
TEST(IsotonicTest, FindsWhatIsThere)
{
  EXPECT_GE(shares_of({0., 1.5, 2.4, 3., 3., 3.}, six_runs).holds, 0.9); // saturates
  EXPECT_GE(shares_of({0., 0.6, 1.2, 1.8, 2.4, 3.}, six_runs).holds, 0.9);
  EXPECT_GE(shares_of({0., 1.8, 3., 3.}, four_runs).holds, 0.85);
  // Sequences that fall at the end or in the middle must be distinguished from a rise.
  EXPECT_LE(shares_of({0., 2., 4., 4., 4., 0.}, six_runs).holds, 0.15);
  EXPECT_LE(shares_of({0., 2., 4., -2., 4., 4.}, six_runs).holds, 0.15);
}

// From seeds to the verdict: rows of a study of six runs.
TEST(StudyRules, DecideWronglyAsOftenAsTheySay)
{
  constexpr std::size_t n = 200;
  std::mt19937_64 generator(54);
  std::size_t rises = 0, above = 0;
  for (std::size_t draw = 0; draw < n; ++draw)
  {
    std::vector<PlannedRun> plan;
    std::vector<RunOutcome> outcomes;
    for (std::size_t run = 0; run < six_runs.size(); ++run)
      for (std::size_t seed = 0; seed < six_runs[run]; ++seed)
      {
        PlannedRun planned;
        planned.run = std::string(1, static_cast<char>('a' + run));
        planned.seed = seed;
        planned.zeta = static_cast<double>(run);
        plan.push_back(planned);
        RunOutcome outcome;
        outcome.run = planned.run;
        outcome.seed = seed;
        outcome.state = RunState::measured;
        outcome.values["wavelength"] = 0.02 + 0.001 * standard_normal(generator);
        outcomes.push_back(outcome);
      }
    StudyRow row;
    row.runs = {"a", "b", "c", "d", "e", "f"};
    row.quantity = "wavelength";
    row.rule = Rule::rises;
    row.against = "zeta";
    rises += judge(row, plan, outcomes, {}).verdict == RowVerdict::holds;
    row.runs = {"a"};
    row.rule = Rule::above;
    row.against.clear();
    row.bound_run = "e";
    above += judge(row, plan, outcomes, {}).verdict == RowVerdict::holds;
  }
  EXPECT_LE(static_cast<double>(rises) / n, above_nominal(n));
  EXPECT_LE(static_cast<double>(above) / n, above_nominal(n));
}

} // namespace statistical_tests_test
