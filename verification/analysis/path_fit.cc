#include "verification/analysis/path_fit.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "support/dense.h"
#include "support/fits.h"

namespace latcon::analysis
{
namespace
{

/// Fitted interval of a path. Coordinates relative to its middle in units of its length keep the columns of the model
/// of similar size.
struct Stretch
{
  double origin;
  double length;
};

/// Returns the columns 1, u, sin, cos of the model at one wave number, u = (X - origin) / length.
Eigen::MatrixXd linear_columns(const ColumnMeans &path, const Stretch &stretch, double wave_number)
{
  const double q = 2. * M_PI * wave_number;
  Eigen::MatrixXd columns(path.size(), 4);
  columns.col(0).setOnes();
  columns.col(1) = (path.X().array() - stretch.origin) / stretch.length;
  columns.col(2) = path.mean_of([&](double X) { return std::sin(q * (X - stretch.origin)); });
  columns.col(3) = path.mean_of([&](double X) { return std::cos(q * (X - stretch.origin)); });
  return columns;
}

// Values less their least-squares fit by columns.
Eigen::VectorXd residual(const Eigen::MatrixXd &columns, const Eigen::VectorXd &values)
{
  return values - columns * support::least_squares(columns, values);
}

} // namespace

ColumnMeans::ColumnMeans(std::vector<double> X, std::vector<double> Y, double width) : X_(std::move(X))
{
  if (X_.size() != Y.size() || !(width > 0.))
    throw std::invalid_argument("a path needs equal numbers of X and Y, and columns of positive width");
  double current_column = -1.;
  for (std::size_t i = 0; i < X_.size(); ++i)
  {
    const double column = std::floor((X_[i] - X_[0]) / width);
    if (column > current_column)
      first_.push_back(i);
    current_column = column;
  }
  const auto n_columns = static_cast<Eigen::Index>(first_.size());
  first_.push_back(X_.size());
  X_mean_.resize(n_columns);
  Y_mean_.resize(n_columns);
  for (Eigen::Index column = 0; column < n_columns; ++column)
  {
    const std::size_t begin = first_[static_cast<std::size_t>(column)];
    const auto n_entries = static_cast<Eigen::Index>(first_[static_cast<std::size_t>(column) + 1] - begin);
    X_mean_(column) = Eigen::Map<const Eigen::VectorXd>(X_.data() + begin, n_entries).mean();
    Y_mean_(column) = Eigen::Map<const Eigen::VectorXd>(Y.data() + begin, n_entries).mean();
  }
}

double Sinusoid::operator()(double X) const
{
  const double phase = 2. * M_PI * (X - origin) / wavelength;
  return offset + slope * (X - origin) + sine * std::sin(phase) + cosine * std::cos(phase);
}

Sinusoid Sinusoid::about(double X) const
{
  const double turn = 2. * M_PI * (X - origin) / wavelength, c = std::cos(turn), s = std::sin(turn);
  return {X, offset + slope * (X - origin), slope, sine * c - cosine * s, cosine * c + sine * s, wavelength};
}

std::optional<SinusoidFit> fit_sinusoid(const ColumnMeans &path, double shortest_wavelength, double resolution)
{
  if (path.size() < min_columns_of_sinusoid)
    return std::nullopt;
  const double X_begin = path.X()(0);
  const double X_end = path.X()(path.size() - 1);
  const Stretch stretch{0.5 * (X_begin + X_end), X_end - X_begin};
  if (!(shortest_wavelength > 0.) || shortest_wavelength >= stretch.length)
    return std::nullopt;

  const auto unexplained = [&](double wave_number)
  { return residual(linear_columns(path, stretch, wave_number), path.Y()).squaredNorm(); };
  const double lowest = 1. / stretch.length;
  const double highest = 1. / shortest_wavelength;
  const double step = 1. / (8. * stretch.length);
  double best_wave_number = lowest;
  double least = unexplained(lowest);
  for (double wave_number = lowest + step; wave_number <= highest; wave_number += step)
  {
    const double value = unexplained(wave_number);
    if (value < least)
    {
      least = value;
      best_wave_number = wave_number;
    }
  }
  const double wave_number = support::golden_section(unexplained, std::max(lowest, best_wave_number - step),
                                            std::min(highest, best_wave_number + step), 1e-7 * best_wave_number);

  const Eigen::MatrixXd columns = linear_columns(path, stretch, wave_number);
  const Eigen::VectorXd c = support::least_squares(columns, path.Y()), left = path.Y() - columns * c;

  SinusoidFit result{};
  result.curve = {stretch.origin, c(0), c(1) / stretch.length, c(2), c(3), 1. / wave_number};
  const double amplitude = result.curve.amplitude();
  if (!(amplitude > resolution))
    return std::nullopt; // the wave number of a path without waviness is undefined

  // Linearised model; the fifth column is the derivative with respect to the wave number.
  Eigen::MatrixXd jacobian(path.size(), 5);
  jacobian << columns, path.mean_of(
                         [&](double X)
                         {
                           const double phase = 2. * M_PI * wave_number * (X - stretch.origin);
                           return 2. * M_PI * (X - stretch.origin) * (c(2) * std::cos(phase) - c(3) * std::sin(phase));
                         });
  const NoiseFit with_sinusoid = fit_noise(path.X(), jacobian, left, resolution);
  const Eigen::MatrixXd covariance = least_squares_covariance(with_sinusoid.noise, path.X(), jacobian);
  const Eigen::Vector2d direction(c(2) / amplitude, c(3) / amplitude);
  result.amplitude = {amplitude, std::sqrt(direction.dot(covariance.block<2, 2>(2, 2) * direction))};
  result.wavelength = {1. / wave_number, std::sqrt(covariance(4, 4)) / (wave_number * wave_number)};

  const Eigen::MatrixXd straight = columns.leftCols(2);
  const NoiseFit without_sinusoid = fit_noise(path.X(), straight, path.Y(), resolution);
  const auto count = static_cast<double>(path.size());
  const double variance_about_line = residual(straight, path.Y()).squaredNorm() / count;
  const double residual_variance = left.squaredNorm() / count;
  // Volume of the uniform prior of (sine, cosine, wave number): a disc of radius sqrt(2 variance) times an interval.
  const double prior_volume = 2. * M_PI * variance_about_line * highest;
  result.log_evidence = with_sinusoid.log_evidence - without_sinusoid.log_evidence - std::log(prior_volume);
  result.residual_rms = std::sqrt(residual_variance);
  const double explained = variance_about_line - residual_variance;
  result.R_squared = explained / variance_about_line;
  const Eigen::Index n_pairs = path.size() - 1;
  const double remembered = std::max(0., left.head(n_pairs).dot(left.tail(n_pairs)) / static_cast<double>(n_pairs));
  result.share_of_path = explained / (explained + remembered);
  return result;
}

Measured fit_slope(const Eigen::VectorXd &position, const Eigen::VectorXd &samples, double resolution)
{
  const Eigen::Index n = samples.size();
  if (position.size() != n || n < 4)
    throw std::invalid_argument("a slope and its uncertainty need at least four samples");
  const Eigen::VectorXd centred = position.array() - position.mean();
  const double spread = centred.squaredNorm();
  // The least-squares slope is a weighted mean of the slopes between neighbouring samples.
  Eigen::VectorXd middle(n - 1), slope(n - 1), weight(n - 1);
  double sum = 0.;
  for (Eigen::Index i = 0; i + 1 < n; ++i)
  {
    const double step = position(i + 1) - position(i);
    sum += centred(i);
    middle(i) = position(i) + 0.5 * step;
    slope(i) = (samples(i + 1) - samples(i)) / step;
    weight(i) = -sum * step / spread;
  }
  const double slope_resolution = resolution * static_cast<double>(n - 1) / (position(n - 1) - position(0));
  const CorrelatedNoise noise = fit_noise(middle, Eigen::VectorXd::Ones(n - 1), slope, slope_resolution).noise;
  return {weight.dot(slope), std::sqrt(weight.dot(covariance(noise, middle) * weight))};
}

} // namespace latcon::analysis
