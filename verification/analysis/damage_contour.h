#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "verification/analysis/crack_measurement.h"

namespace latcon::analysis
{

/// Damage at the nodes of a uniform grid: node (i, j) has X = i size_x, Y = bottom + j size_y and the index
/// j columns + i.
struct DamageImage
{
  std::size_t columns, rows;        ///< of nodes, >= 2
  double size_x, size_y;            ///< of a cell, reference [m], > 0
  double bottom;                    ///< [m]
  const std::vector<double> *nodal; ///< d [-], columns times rows values

  double at(std::size_t i, std::size_t j) const { return (*nodal)[j * columns + i]; }
};

/// Damage on the contour that counts as the edge of a crack [-].
inline constexpr double contour_level = 0.5;

/// What a crack is in one column of nodes, between whose neighbours the contour is interpolated linearly.
struct ContourColumn
{
  double X;              ///< reference [m]
  std::size_t n_strands; ///< separate intervals of Y with damage above the level, > 0
  double lower, upper;   ///< outermost edges of all strands, reference Y [m]
  double damaged;        ///< total height of the strands [m]
  double gap;            ///< widest between neighbouring strands [m]; 0 with one strand

  double centre() const { return 0.5 * (lower + upper); }
};

/// Returns the crack in column `i`; none if its damage is below the level.
[[nodiscard]] std::optional<ContourColumn> contour_column(const DamageImage &image, std::size_t i);

/// Returns the columns of the crack from `from` [m] on, up to its tip: the first column without damage ends it.
[[nodiscard]] std::vector<ContourColumn> contour(const DamageImage &image, double from);

/// Returns the fraction of the columns between X_begin and X_end [m] in which the crack has branches: strands whose
/// gaps are as wide and as long as a BranchRule demands, in lengths d [m] and not in cells. Columns must be those of
/// contour(), which have the distance of the nodes.
[[nodiscard]] double branched_fraction(const std::vector<ContourColumn> &columns, double X_begin, double X_end,
                                       double spacing, const BranchRule &rule = {});

/// Place of the tip: the last column of the crack, in which the node with the most damage decides on Y.
struct ContourTip
{
  std::size_t column; ///< of nodes
  double X;           ///< where the damage falls to the level beyond that column, reference [m]
  double Y;           ///< middle of the strand of that node, reference [m]
};

/// Returns the tip of the crack that contains `column`, or grew beyond it; none if that column has no damage above the
/// level.
[[nodiscard]] std::optional<ContourTip> contour_tip(const DamageImage &image, std::size_t column);

/// Contour of a crack in the window of a measurement, each line fitted by a sinusoid. A crack whose edges move towards
/// and away from each other (varicose) has a width that varies, but a straight centre line.
struct ContourMeasurement
{
  std::optional<SinusoidFit> centre, lower, upper, width; ///< none: too short, or straight within the resolution
  double mean_width = 0.;                                 ///< of all damage above the level, strands added [m]
  double rms_width = 0.;       ///< standard deviation of the distance between the outermost edges [m]
  double rms_centre = 0.;      ///< standard deviation of the centre line [m]
  double several_strands = 0.; ///< fraction of the columns with two strands or more [-]
};

/// Measures a contour between X_begin and X_end [m], without the columns closer to its tip than its largest width: the
/// crack is narrower there.
/// @param spacing length over which lines are averaged, see ColumnMeans, [m], > 0
/// @param min_wavelength of the fits, in spacings
/// @return none if there are fewer than two columns
[[nodiscard]] std::optional<ContourMeasurement> measure_contour(const std::vector<ContourColumn> &columns,
                                                                double X_begin, double X_end, double spacing,
                                                                double min_wavelength);

} // namespace latcon::analysis
