#pragma once

#include <vector>

namespace latcon::lattice
{

class TriangularLattice;

/// Bonds of rings between scattered points (theory-comparison.md, eqs. (H.29) and (H.30)).
///
/// Two points are joined if their distance is nearer than the spacing to the radius of a ring. Weights are those of
/// greatest entropy, relative to weights that fall linearly with that difference, with which the sum at each point is
/// that of a grid, the mean over all bonds has the fourth moments of all directions, and forces at each point nearly
/// balance in a homogeneous strain: up to 1 % of the multipliers of their first and third harmonics. Without the
/// balance the bonds of a loaded sheet at rest would differ by several percent in stretch.
struct ScatteredBonds
{
  /// @param lattice complete but for these bonds @throws std::invalid_argument if there are no such weights
  explicit ScatteredBonds(const TriangularLattice &lattice);

  /// Weight q by kind and place where the bond starts, both ends of which may be beyond the edges but not at once [-].
  std::vector<std::vector<double>> weights;
  /// Rest length of the kind over that of the bond, likewise; 0: no bond [-].
  std::vector<std::vector<double>> length_ratios;
  /// Weights of the kinds with which the sum of q / |R|^2 over half-bonds is the largest of all points.
  std::vector<double> bounding_weights;
  double shortest = 0.;       ///< rest length of the shortest bond [m]
  double bonds_of_point = 0.; ///< mean number
};

} // namespace latcon::lattice
