#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "verification/analysis/correlated_noise.h"

namespace latcon::analysis
{

/// Measured value and one standard deviation of its error, both in the unit of the quantity.
struct Measured
{
  double value;
  double uncertainty;
};

/// Path Y(X) averaged over columns of equal width, so that every length of crack has the same weight, independent of
/// the density of records. Columns without an entry are omitted.
class ColumnMeans
{
public:
  /// @param X, Y entries of the path [m], of equal size, X not decreasing
  /// @param width of a column [m], > 0
  ColumnMeans(std::vector<double> X, std::vector<double> Y, double width);

  Eigen::Index size() const { return X_mean_.size(); } ///< number of columns with an entry
  const Eigen::VectorXd &X() const { return X_mean_; } ///< mean X of the entries of each column [m]
  const Eigen::VectorXd &Y() const { return Y_mean_; } ///< mean Y of the entries of each column [m]

  /// Returns the mean of a function of X over the entries of each column. A model that is averaged in the same way as
  /// the path is not biased by the width of the columns.
  template <typename Function>
  Eigen::VectorXd mean_of(const Function &function) const
  {
    Eigen::VectorXd mean(size());
    for (Eigen::Index column = 0; column < size(); ++column)
    {
      const std::size_t begin = first_[static_cast<std::size_t>(column)];
      const std::size_t end = first_[static_cast<std::size_t>(column) + 1];
      double sum = 0.;
      for (std::size_t i = begin; i < end; ++i)
        sum += function(X_[i]);
      mean(column) = sum / static_cast<double>(end - begin);
    }
    return mean;
  }

private:
  std::vector<double> X_;
  std::vector<std::size_t> first_; // first entry per column, and one past the last entry
  Eigen::VectorXd X_mean_;
  Eigen::VectorXd Y_mean_;
};

/// Sinusoid with drift: Y(X) = offset + slope (X - origin) + sine sin(2 pi (X - origin) / wavelength) + cosine
/// cos(same).
struct Sinusoid
{
  double origin;       ///< middle of the fitted interval, reference X [m]
  double offset;       ///< [m]
  double slope;        ///< drift across the sheet [-]
  double sine, cosine; ///< [m]
  double wavelength;   ///< [m], > 0

  double amplitude() const { return std::hypot(sine, cosine); } ///< half of peak to peak [m]
  double operator()(double X) const;                            ///< Y [m]
  Sinusoid about(double X) const;                               ///< the same curve with this origin [m]
};

/// Smallest number of columns for a fit: one and a half times the five coefficients and the three parameters of the
/// noise.
inline constexpr Eigen::Index min_columns_of_sinusoid = 12;

/// Least-squares fit of a sinusoid to a path.
struct SinusoidFit
{
  Sinusoid curve;
  Measured wavelength; ///< [m]
  Measured amplitude;  ///< [m]
  double residual_rms; ///< of the column means [m]
  double R_squared;    ///< fraction of the variance about the best straight line that the sinusoid explains [-]
  /// R_squared without the part of the residual that is uncorrelated between columns [-]: hops of the tip between sites
  /// are an error of the record and not part of the path.
  double share_of_path;
  /// Logarithm of the Bayes factor of "sinusoid and noise" against "straight line and noise", each with its best
  /// correlated noise: above 3, 20 to 1; above 5, 150 to 1. The prior is uniform over wave numbers up to the highest
  /// one of the search and over (sine, cosine) up to an amplitude that accounts for the whole variance. A random walk,
  /// which some slow sinusoid always fits well, gets no evidence from that fit.
  double log_evidence;
};

/// Fits a sinusoid by least squares over all wavelengths from `shortest_wavelength` to the length of the path.
///
/// The four linear coefficients are eliminated (variable projection); the wave number is scanned at an eighth of the
/// spacing of independent wave numbers, 1 / length, and refined by golden-section search about the lowest value, which
/// lies within one scan step. Uncertainties are those of the linearised problem with the noise in the residuals.
/// @param resolution smallest standard deviation of Y [m], > 0
/// @return none if there are too few columns, if the path is shorter than the shortest wavelength, or if it is straight
/// within the resolution
std::optional<SinusoidFit> fit_sinusoid(const ColumnMeans &path, double shortest_wavelength, double resolution);

/// Fits a straight line by least squares and returns its slope [unit of samples / unit of position].
///
/// The slope is a weighted mean of the slopes between consecutive samples; the uncertainty is that of this mean for
/// slopes with correlated noise. It accounts for a rate that wanders, for which the position drifts away from the line;
/// for a constant rate it is an overestimate.
/// @param position strictly increasing
/// @param resolution smallest standard deviation [unit of the samples], > 0
/// @throws std::invalid_argument for fewer than four samples
Measured fit_slope(const Eigen::VectorXd &position, const Eigen::VectorXd &samples, double resolution);

} // namespace latcon::analysis
