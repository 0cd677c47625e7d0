#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "verification/analysis/correlated_noise.h"

namespace latcon::analysis
{

/// A measured value and one standard deviation of its error, both in the unit of the quantity.
struct Measured
{
  double value;
  double uncertainty;
};

/// A path Y(X) averaged over columns of equal width, so that every length of crack has the same weight however densely
/// the tip was recorded there. Columns without an entry are left out.
class ColumnMeans
{
public:
  /// @param X, Y entries of the path [m], X not decreasing, both of one size
  /// @param width of a column [m], > 0
  ColumnMeans(std::vector<double> X, std::vector<double> Y, double width);

  Eigen::Index size() const { return X_mean_.size(); } ///< columns that hold an entry
  const Eigen::VectorXd &X() const { return X_mean_; } ///< mean X of the entries of each column [m]
  const Eigen::VectorXd &Y() const { return Y_mean_; } ///< mean Y of the entries of each column [m]

  /// Mean over the entries of each column of a function of X. A model averaged as the path was is not flattened by the
  /// width of the columns.
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
  std::vector<std::size_t> first_; // first entry of each column, and one past the last entry
  Eigen::VectorXd X_mean_;
  Eigen::VectorXd Y_mean_;
};

/// Y(X) = offset + slope (X - origin) + sine sin(2 pi (X - origin) / wavelength) + cosine cos(same).
struct Sinusoid
{
  double origin;       ///< middle of the fitted stretch, reference X [m]
  double offset;       ///< [m]
  double slope;        ///< drift across the sheet [-]
  double sine, cosine; ///< [m]
  double wavelength;   ///< [m], > 0

  double amplitude() const { return std::hypot(sine, cosine); } ///< half of peak to peak [m]
  double operator()(double X) const;                            ///< Y [m]
};

/// Least number of columns for a sinusoid: its five coefficients, the three numbers of the noise, and half as many
/// again.
inline constexpr Eigen::Index min_columns_of_sinusoid = 12;

/// The sinusoid nearest to a path.
struct SinusoidFit
{
  Sinusoid curve;
  Measured wavelength; ///< [m]
  Measured amplitude;  ///< [m]
  double residual_rms; ///< of the column means [m]
  double R_squared;    ///< part of the variance about the best straight line that the sinusoid explains [-]
  /// The same without that part of the residual which is forgotten from one column to the next [-]: hops of the tip
  /// between sites are an error of the record, not a shape of the path.
  double share_of_path;
  /// ln of the odds (Bayes factor) of "sinusoid and noise" against "straight line and noise", each with the correlated
  /// noise that suits it best: above 3, 20 to 1; above 5, 150 to 1. Before the measurement all wave numbers up to the
  /// highest one looked for count as equally likely, and so do all (sine, cosine) up to an amplitude that accounts for
  /// the whole variance. A random walk, which some slow sinusoid always follows well, gains nothing by it.
  double log_evidence;
};

/// Least-squares sinusoid over all wavelengths from `shortest_wavelength` to the length of the path.
///
/// The four linear coefficients are eliminated (variable projection); the wave number is scanned at an eighth of the
/// spacing of independent wave numbers, 1 / length, and refined by golden-section search about the lowest value, which
/// lies within one scan step. Uncertainties are those of the linearised problem under the noise left in the residuals.
/// @param resolution standard deviation below which values of Y are not told apart [m], > 0
/// @return none if there are too few columns, if the path is shorter than the shortest wavelength, or if it is straight
/// to within the resolution
std::optional<SinusoidFit> fit_sinusoid(const ColumnMeans &path, double shortest_wavelength, double resolution);

/// Slope of the least-squares straight line through samples [unit of samples / unit of position].
///
/// The line's slope is a weighted mean of the slopes from sample to sample; the uncertainty is that of this mean when
/// the slopes carry correlated noise. So a rate that wanders, and with it a position that drifts ever further from the
/// line, is accounted for; a rate that does not wander at all gets too large an uncertainty rather than too small a
/// one.
/// @param position strictly increasing
/// @param resolution standard deviation below which samples are not told apart [unit of the samples], > 0
/// @throws std::invalid_argument for fewer than four samples
Measured fit_slope(const Eigen::VectorXd &position, const Eigen::VectorXd &samples, double resolution);

} // namespace latcon::analysis
