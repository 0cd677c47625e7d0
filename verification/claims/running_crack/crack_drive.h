#pragma once

#include <cmath>

#include "lattice/triangular_lattice.h"

namespace latcon::claims
{

/// A straight crack driven through a sheet held at all edges: X_tip(t) = start + speed * t along the middle of the
/// sheet, from an unbroken sheet at rest at x = F X (theory-comparison.md, section "A running crack"). Both sides are
/// given these numbers and nothing else in common.
///
/// In the lattice the crack runs midway between the two rows of sites (columns of them, where rows run across the
/// crack) next above the axis, where each bond that crosses that line is cut as the tip passes the crossing point. The
/// lattice is symmetric about that line up to a shift by `stride()` along it. The tip therefore moves by a stride from
/// sample to sample, so that each point that moves with the tip meets sites of either side alike.
struct CrackDrive
{
  double spacing; ///< d [m]
  lattice::Orientation orientation;
  double length;          ///< of the sheet [m]
  double height;          ///< of the whole sheet [m]
  double start;           ///< X of the tip at t = 0 [m]; the left edge is at 0
  double speed;           ///< V [m/s] > 0
  unsigned int n_strides; ///< strides that the tip makes, >= n_samples

  static constexpr unsigned int n_samples = 4; ///< after the last strides

  bool rows_along() const { return orientation == lattice::Orientation::rows_along_crack; }
  /// Shift along the crack under which the lattice is its own mirror image, and way of the tip between samples [m].
  double stride() const { return spacing * (rows_along() ? 0.5 : std::sqrt(0.75)); }
  double stride_time() const { return stride() / speed; } ///< [s]
  /// Distance of lines of sites along the crack [m].
  double pitch() const { return spacing * (rows_along() ? std::sqrt(0.75) : 0.5); }
  double axis() const { return 0.5 * pitch(); }                                 ///< Y of the crack in the lattice [m]
  double tip(unsigned int strides) const { return start + strides * stride(); } ///< X [m]
  double end() const { return tip(n_strides); }                                 ///< last X of the tip [m]

  /// Places the start such that no sample meets the cut of a bond. @param near X [m]
  void start_near(double near) { start = (std::round(near / stride()) + first_phase) * stride(); }
  static constexpr double first_phase = 0.25; ///< of the start, in strides from a site
};

} // namespace latcon::claims
