#pragma once

#include <Eigen/Core>

namespace latcon::analysis
{

/// Stationary noise along a coordinate s (reference X [m], or time [s]): a white part, such as a tip that hops between
/// sites, and a part with a correlation length, such as a path that wanders,
///   C(s, s') = variance [ (1 - f) delta(s, s') + f exp(-|s - s'| / length) ],   f = correlated_fraction.
/// For lengths much larger than the record the second part is a random walk.
struct CorrelatedNoise
{
  double variance;            ///< of one sample [unit of the samples squared], >= 0
  double correlated_fraction; ///< f [-], in [0, 1)
  double correlation_length;  ///< [unit of s], > 0; unused if f = 0
};

/// Noise in the residuals of a linear model, and the evidence for model and noise.
struct NoiseFit
{
  CorrelatedNoise noise;
  /// Logarithm of the likelihood of the samples, integrated over all coefficients of the model (flat prior), at the
  /// noise that maximises it. Differences between models weigh the fit of additional coefficients against their
  /// freedom.
  double log_evidence;
};

/// Estimates the noise in `samples` that the linear model `design` * coefficients does not explain.
///
/// Variance, f and length maximise the restricted likelihood (integrated over the coefficients), the last two on a
/// grid. Unlike the autocorrelation of the residuals, this estimate is not biased towards short correlation by the
/// fitted coefficients.
/// @param position s of the samples, strictly increasing
/// @param design one row per sample, one column per coefficient, of full rank
/// @param samples one per position, more than the columns of `design`
/// @param resolution smallest standard deviation [unit of the samples], > 0; keeps the likelihood finite if a model
/// fits exactly
/// @throws std::invalid_argument if sizes do not match or positions do not increase
NoiseFit fit_noise(const Eigen::VectorXd &position, const Eigen::MatrixXd &design, const Eigen::VectorXd &samples,
                   double resolution);

/// Returns the covariance matrix of samples at `position` [unit of the samples squared].
Eigen::MatrixXd covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position);

/// Returns the covariance of the ordinary least-squares coefficients of `design` for samples with this noise,
///   (D^T D)^-1 D^T C D (D^T D)^-1,
/// which is sigma^2 (D^T D)^-1 for white noise, and larger for noise that is correlated over the scale on which the
/// columns of D vary.
Eigen::MatrixXd least_squares_covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position,
                                         const Eigen::MatrixXd &design);

} // namespace latcon::analysis
