/// Power law of a quantity above its onset.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "verification/study/statistical_tests.h"

namespace latcon::study
{

/// Estimate with a 95 % confidence interval that need not be symmetric, in the unit of the quantity.
struct Interval
{
  double value, low, high;
};

/// Mean of a quantity at one value of a parameter.
struct OnsetPoint
{
  double parameter; ///< p, in any unit
  SampleMean mean;  ///< A, in any unit
};

/// Smallest exponent that fit_onset() considers. The range includes 1/4 (tricritical), 1/2 (Hopf) and 1 (transcritical
/// bifurcation).
inline constexpr double min_onset_exponent = 0.05;
/// Largest exponent that fit_onset() considers.
inline constexpr double max_onset_exponent = 3.;

/// Fit of A = C (p - p_c)^beta.
struct OnsetFit
{
  Interval exponent; ///< beta; an end at min_onset_exponent or max_onset_exponent is not bounded by the data
  Interval onset;    ///< p_c, in the unit of the parameter
  double prefactor;  ///< C
  /// Probability that the scatter of the seeds explains distances of the means from the curve as large as these: small
  /// if they do not follow it.
  double p_fit;
  /// Returns true if the data bound the exponent on both sides.
  bool is_bounded() const { return exponent.low > min_onset_exponent && exponent.high < max_onset_exponent; }
};

/// Fits A = C (p - p_c)^beta to means above an onset by least squares, weighted with the numbers of seeds, with C, p_c
/// and beta free. For a supercritical Hopf bifurcation beta = 1/2 (S. H. Strogatz, Nonlinear Dynamics and Chaos,
/// section 8.2).
///
/// C is linear and eliminated; p_c is minimised over for each beta, from ten times the range of the parameters below
/// the smallest of them up to it. The intervals are those of the profile likelihood for normal errors of common
/// variance s^2: all values for which the least sum of squares S exceeds its minimum by at most F(1, nu; 95 %) s^2 (D.
/// M. Bates, D. G. Watts, Nonlinear Regression Analysis and its Applications, Wiley 1988, section 6.1). s^2 is the
/// larger of the pooled variance of the seeds (at least the squared uncertainty of single measurements) and of the mean
/// square of what the curve leaves, so that a curve that does not fit has wider intervals; nu are the degrees of
/// freedom of that one: for five means, 2 of the curve.
/// @param points means above the onset, in any order
/// @return none for fewer than five points, parameters that are not distinct, numbers that are not finite, means that
/// are not positive, or seeds without scatter
[[nodiscard]] std::optional<OnsetFit> fit_onset(std::vector<OnsetPoint> points);

} // namespace latcon::study
