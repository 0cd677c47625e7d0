#pragma once

#include <string>
#include <vector>

#include "lattice/constraint.h"

namespace latcon::input
{

struct Case;
class Parameters;

/// Entries of a case for strains of its edges that change during a motion of the lattice: piecewise linear in time,
/// from the loading at the start through the strains of each instant, and constant from the last one on.
struct LoadingHistory
{
  std::vector<double> times;    ///< [s]
  std::vector<double> strain_x; ///< [-]; empty: that of the loading
  std::vector<double> strain_y; ///< [-], likewise

  bool empty() const { return times.empty(); }
  void declare(Parameters &parameters);
  void check(Parameters &parameters) const;
  /// Deformations F at the start and at each instant; surplus strains, which check() refuses, are left out.
  std::vector<Eigen::Matrix2d> deformations(const Eigen::Matrix2d &start) const;
};

/// Refuses strains that change, for a `reason`.
void require_constant_loading(const Case &input, Parameters &parameters, const std::string &reason);

/// Constraints of the edges of a case: its rollers, and the motion of all held sites.
/// @param state of the sheet, which tells the held sites
std::vector<lattice::Constraint> edge_constraints(const Case &input, const lattice::State &state,
                                                  const lattice::TriangularLattice &sheet);

} // namespace latcon::input
