/// Statistical tests of means over seeds, at the level `significance`.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace latcon::study
{

/// Significance level: probability that a test finds a difference if there is none.
inline constexpr double significance = 0.05;

/// Mean of independent, normally distributed measurements of a quantity, in any unit.
struct SampleMean
{
  double mean;
  std::size_t n;            ///< number of measurements, >= 1
  double variance = 0.;     ///< sample variance of one measurement, n - 1 degrees of freedom; unused if n is 1
  double min_variance = 0.; ///< squared uncertainty of one measurement; 0: unknown

  /// Returns the variance of one measurement, at least `min_variance`. The sample variance includes the uncertainty
  /// of single measurements, so it is smaller only by chance. With the larger value tests find fewer differences, never
  /// more.
  double floored_variance() const { return variance > min_variance ? variance : min_variance; }
};

/// Returns the one-sided p-value of Welch's t-test for samples with different variances (B. L. Welch, Biometrika 34, 28
/// (1947)): small if the mean of `larger` exceeds that of `smaller`. Degrees of freedom are those of F. E.
/// Satterthwaite (Biometrics Bull. 2, 110 (1946)), rounded down: for equal means the value is below 0.05 in at most 5 %
/// of cases with two to five measurements of equal variance, and in 6.2 % for samples of two and five of which the
/// latter has a third of the standard deviation.
/// @return none if the error cannot be estimated: fewer than two measurements in a sample, or zero variance in both
std::optional<double> welch_p_value(const SampleMean &smaller, const SampleMean &larger);

/// Adjusts the p-values of several comparisons after Holm (S. Holm, Scand. J. Statist. 6, 65 (1979)): the probability
/// that at least one of them falls below a bound by chance is at most that bound. The order is unchanged, and NaN
/// remains NaN.
std::vector<double> adjust_by_holm(const std::vector<double> &p_values);

/// Returns the level probabilities P(l, k; w) that the isotonic fit to k normal numbers with mean 0 and variances 1 / w
/// has l different values, l = 1 to k, at index l - 1 (Robertson, Wright, and Dykstra, Order Restricted Statistical
/// Inference, Wiley 1988, section 2.3). The isotonic fit, the closest non-decreasing sequence, is computed by pooling
/// adjacent violators. Estimated from 20,000 draws of a fixed sequence of random numbers, with a standard deviation of
/// at most 0.004.
/// @param weights w, > 0
std::vector<double> level_probabilities(const std::vector<double> &weights);

/// p-values of an isotonic test, under equal means.
struct TrendTest
{
  double p_rise; ///< of an equally clear rise: small if the means rise
  double p_fall; ///< of an equally clear violation of the order: small if the means fall somewhere
};

/// Performs two likelihood-ratio tests of means that should rise in the given order, for samples with a common variance
/// (D. J. Bartholomew, Biometrika 46, 36 (1959); Robertson et al., chapter 2). With the isotonic fit m* to the means m,
/// weights n, their grand mean m0, and the pooled variance s^2 with nu degrees of freedom,
///   S_01 = sum n (m* - m0)^2 / s^2 tests equal means against means that rise,
///   S_12 = sum n (m - m*)^2 / s^2 tests non-decreasing means against any others; equal means are its worst case.
/// Under equal means, given that the fit has l values, the two sums are chi-squared variables with l - 1 and k - l
/// degrees of freedom, independent of s^2:
///   P(S_01 >= c) = sum over l > 1 of P(l, k; n) P(F(l - 1, nu) >= c / (l - 1)),
///   P(S_12 >= c) = sum over l < k of P(l, k; n) P(F(k - l, nu) >= c / (k - l)).
/// A sequence that rises until it saturates passes both tests. They make one statement about all means instead of one
/// per pair.
/// @param samples two or more
/// @param levels level_probabilities() of their n
/// @return none if the error cannot be estimated: no sample with two measurements, or zero variance in all
std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples, const std::vector<double> &levels);

/// Performs the isotonic test with the level probabilities of these samples.
std::optional<TrendTest> isotonic_test(const std::vector<SampleMean> &samples);

} // namespace latcon::study
