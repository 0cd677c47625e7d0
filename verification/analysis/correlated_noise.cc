#include "verification/analysis/correlated_noise.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/dense.h"

namespace latcon::analysis
{
namespace
{

/// Transforms rows with correlated noise of unit variance in place to rows with independent noise of unit variance, by
/// the one-state Kalman filter of this noise. Takes O(rows); positions may have gaps.
/// @return log det of the correlation matrix
double whiten(Eigen::MatrixXd &rows, const Eigen::VectorXd &position, double correlated_fraction,
              double correlation_length)
{
  Eigen::RowVectorXd predicted = Eigen::RowVectorXd::Zero(rows.cols());
  double predicted_variance = correlated_fraction;
  double log_determinant = 0.;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
  {
    if (i > 0)
    {
      const double memory = std::exp(-(position(i) - position(i - 1)) / correlation_length);
      predicted *= memory;
      predicted_variance = memory * memory * predicted_variance + (1. - memory * memory) * correlated_fraction;
    }
    const double innovation_variance = predicted_variance + (1. - correlated_fraction);
    const Eigen::RowVectorXd innovation = rows.row(i) - predicted;
    const double gain = predicted_variance / innovation_variance;
    predicted += gain * innovation;
    predicted_variance *= 1. - gain;
    rows.row(i) = innovation / std::sqrt(innovation_variance);
    log_determinant += std::log(innovation_variance);
  }
  return log_determinant;
}

} // namespace

NoiseFit fit_noise(const Eigen::VectorXd &position, const Eigen::MatrixXd &design, const Eigen::VectorXd &samples,
                   double resolution)
{
  const Eigen::Index n = samples.size();
  const Eigen::Index n_coefficients = design.cols();
  if (design.rows() != n || position.size() != n || n <= n_coefficients)
    throw std::invalid_argument("a noise estimate needs more samples than coefficients of the model");
  for (Eigen::Index i = 1; i < n; ++i)
    if (!(position(i) > position(i - 1)))
      throw std::invalid_argument("a noise estimate needs samples in increasing order of position");

  const double extent = position(n - 1) - position(0);
  const double shortest = 0.5 * extent / static_cast<double>(n - 1);
  const double floor = static_cast<double>(n) * resolution * resolution;
  // Scale the columns, so that the rank is not affected by round-off.
  const Eigen::RowVectorXd scale = design.colwise().norm();

  const double log_scale = scale.array().log().sum();

  NoiseFit best{};
  best.log_evidence = -std::numeric_limits<double>::infinity();

  const auto consider = [&](double fraction, double length)
  {
    Eigen::MatrixXd rows(n, n_coefficients + 1);
    rows << (design.array().rowwise() / scale.array()).matrix(), samples;
    const double log_determinant = whiten(rows, position, fraction, length);
    double log_information = 0.;
    const Eigen::VectorXd coefficients =
      support::least_squares(rows.leftCols(n_coefficients), rows.col(n_coefficients), &log_information);
    const double sum_of_squares =
      (rows.col(n_coefficients) - rows.leftCols(n_coefficients) * coefficients).squaredNorm() + floor;
    const double freedom = static_cast<double>(n - n_coefficients);
    const double variance = sum_of_squares / freedom;
    const double log_evidence =
      -0.5 * (freedom * (std::log(2. * M_PI * variance) + 1.) + log_determinant + log_information + 2. * log_scale);
    if (log_evidence > best.log_evidence)
      best = {{variance, fraction, length}, log_evidence};
  };

  // A coarse grid suffices: the likelihood of two hundred samples is flat on this scale.
  consider(0., shortest);
  // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): a geometric series
  for (double length = shortest; length < 1.5 * extent; length *= 1.5)
    for (const double fraction : {0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 0.97, 0.999})
      consider(fraction, length);
  return best;
}

Eigen::MatrixXd covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position)
{
  const Eigen::Index n = position.size();
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i)
    {
      const double distance = std::abs(position(i) - position(j));
      result(i, j) = noise.variance * noise.correlated_fraction * std::exp(-distance / noise.correlation_length);
      if (i == j)
        result(i, j) += noise.variance * (1. - noise.correlated_fraction);
    }
  return result;
}

Eigen::MatrixXd least_squares_covariance(const CorrelatedNoise &noise, const Eigen::VectorXd &position,
                                         const Eigen::MatrixXd &design)
{
  const Eigen::RowVectorXd scale = design.colwise().norm();
  const Eigen::MatrixXd scaled = design.array().rowwise() / scale.array();
  Eigen::MatrixXd solve = support::solve_positive(scaled.transpose() * scaled, scaled.transpose());
  solve.array().colwise() /= scale.transpose().array();
  return solve * covariance(noise, position) * solve.transpose();
}

} // namespace latcon::analysis
