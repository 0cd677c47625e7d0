#pragma once

#include <Eigen/Core>

namespace latcon::analysis
{

/// Stationary noise along a coordinate s (reference X [m], or time [s]): a part that is new at every sample, such as a
/// tip that hops between sites, and a part that is remembered over a correlation length, such as a path that wanders,
///   C(s, s') = variance [ (1 - f) delta(s, s') + f exp(-|s - s'| / length) ],   f = correlated_fraction.
/// With length far beyond the record the second part is a random walk.
struct CorrelatedNoise
{
  double variance;            ///< of one sample [unit of the samples squared], >= 0
  double correlated_fraction; ///< f [-], in [0, 1)
  double correlation_length;  ///< [unit of s], > 0; without meaning where f = 0
};

/// Noise left by a linear model, and how well model and noise together explain the samples.
struct NoiseFit
{
  CorrelatedNoise noise;
  /// ln of the likelihood of the samples, integrated over all coefficients of the model (flat prior), at the noise
  /// where it is largest. Its differences between models weigh what more coefficients explain against the freedom they
  /// have.
  double log_evidence;
};

/// Noise in `samples` that the linear model `design` * coefficients does not explain.
///
/// Variance, f and length maximise the restricted likelihood (the one integrated over the coefficients), the last two
/// on a grid. Unlike the autocorrelation of the residuals, it is not biased towards short correlation by the freedom
/// that the model has taken out of them.
/// @param position s of the samples, strictly increasing
/// @param design one row per sample, one column per coefficient, of full rank
/// @param samples as many as positions, more than columns in `design`
/// @param resolution standard deviation below which samples are not told apart [unit of the samples], > 0; keeps the
/// likelihood finite where a model fits exactly
/// @throws std::invalid_argument if sizes do not fit or a position does not increase
NoiseFit fit_noise(const Eigen::VectorXd &position, const Eigen::MatrixXd &design, const Eigen::VectorXd &samples,
                   double resolution);

/// Covariance matrix of samples at `position` [unit of the samples squared].
Eigen::MatrixXd covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position);

/// Covariance of the ordinary least-squares coefficients of `design` when the samples carry this noise,
///   (D^T D)^-1 D^T C D (D^T D)^-1,
/// which is the usual sigma^2 (D^T D)^-1 for white noise and larger for noise that is correlated over the scale on
/// which the columns of D vary.
Eigen::MatrixXd least_squares_covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position,
                                         const Eigen::MatrixXd &design);

} // namespace latcon::analysis
