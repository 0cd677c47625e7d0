/// Statistical tests of means over seeds, each at the level `significance`.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace latcon::study
{

/// Probability with which a test finds a difference where there is none.
inline constexpr double significance = 0.05;

/// Mean of independent, normally distributed measurements of one quantity, in any one unit.
struct SampleMean
{
  double mean;
  std::size_t n;              ///< number of measurements, >= 1
  double variance = 0.;       ///< of one measurement, from their spread: n - 1 degrees of freedom; not used if n is 1
  double least_variance = 0.; ///< square of the uncertainty of one measurement; 0: unknown

  /// Variance of one measurement, at least `least_variance`. The spread contains the uncertainty of single
  /// measurements: one that is smaller is luck. Raising it makes tests find fewer differences, never more.
  double floored_variance() const { return variance > least_variance ? variance : least_variance; }
};

/// One-sided p-value of Welch's t-test for samples with any two variances (B. L. Welch, Biometrika 34, 28 (1947)):
/// small if the mean of `larger` exceeds that of `smaller`. Degrees of freedom by F. E. Satterthwaite (Biometrics Bull.
/// 2, 110 (1946)), rounded down: for equal means the value is below 0.05 in at most 5 % of cases with two to five
/// measurements of equal variance, in 6.2 % with two beside five of a third of their standard deviation.
/// @return none without an estimate of the error: fewer than two measurements in a sample, or no spread in either
std::optional<double> welch_p_value(const SampleMean &smaller, const SampleMean &larger);

/// Holm's adjustment of p-values of several comparisons (S. Holm, Scand. J. Statist. 6, 65 (1979)): the probability
/// that one or more of them fall below a bound by chance is at most that bound. In the given order; not-a-number stays.
std::vector<double> holm_adjusted(const std::vector<double> &p_values);

/// Probabilities P(l, k; w) that the isotonic fit to k normal numbers with mean 0 and variances 1 / w has l different
/// values, l = 1 to k, at index l - 1 (Robertson, Wright, and Dykstra, Order Restricted Statistical Inference, Wiley
/// 1988, section 2.3). The fit, the closest numbers that never fall, pools adjacent violators. From 20,000 draws of a
/// fixed sequence of random numbers: one standard deviation is at most 0.004.
/// @param weights w, > 0
std::vector<double> level_probabilities(const std::vector<double> &weights);

/// Result of an isotonic test: probabilities under equal means.
struct TrendTest
{
  double p_rise; ///< of means that rise as clearly: small if they rise
  double p_fall; ///< of means that break the order as clearly: small if they fall somewhere
};

/// Two likelihood-ratio tests of means against the order in which they should rise, for samples with one common
/// variance (D. J. Bartholomew, Biometrika 46, 36 (1959); Robertson et al., chapter 2). With the isotonic fit m* to the
/// means m, weights n, their grand mean m0, and the pooled variance s^2 with nu degrees of freedom,
///   S_01 = sum n (m* - m0)^2 / s^2 tests equal means against means that rise,
///   S_12 = sum n (m - m*)^2 / s^2 tests means that never fall against any others; equal means are its worst case.
/// Under equal means, given that the fit has l values, the two sums are chi-squared variables with l - 1 and k - l
/// degrees of freedom, independent of s^2:
///   P(S_01 >= c) = sum over l > 1 of P(l, k; n) P(F(l - 1, nu) >= c / (l - 1)),
///   P(S_12 >= c) = sum over l < k of P(l, k; n) P(F(k - l, nu) >= c / (k - l)).
/// A sequence that rises until it saturates passes both: one statement about all means instead of one per pair.
/// @param samples two or more
/// @param levels level_probabilities() of their n
/// @return none without an estimate of the error: no sample of two measurements, or no spread in any
std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples, const std::vector<double> &levels);

/// Isotonic test with the level probabilities of these samples.
std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples);

} // namespace latcon::study
