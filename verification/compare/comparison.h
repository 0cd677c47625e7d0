/// Comparison of a lattice frame and a continuum frame of the same sheet: differences at the sites, and their norms.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <mpi.h>

#include "verification/compare/frame.h"
#include "verification/compare/site_probe.h"
#include "verification/output/results.h"

namespace latcon::compare
{

/// Returns the tolerance of positions [m]: 1e-6 of the larger side of the sheet. Positions in .vtu files have single
/// precision (6e-8), and meshes of other programs six digits (5e-7).
double position_tolerance(const ContinuumFrame &frame);

/// Checks that two frames have the same time. @throws InputError with the times of both, if one frame is of a motion
/// and the other of an equilibrium, or if the times differ by more than time_tolerance, unless the user gave both times
void require_same_time(const LatticeFrame &lattice, const ContinuumFrame &continuum);

/// Checks that two undeformed sheets have the same bounds to position_tolerance(). @throws InputError otherwise; the
/// message mentions different units, or exchanged x and y, where these are likely
void require_same_bounds(const LatticeFrame &lattice, const ContinuumFrame &continuum);

/// Circle in the undeformed sheet.
struct Circle
{
  Position centre; ///< [m]
  double radius;   ///< [m] > 0
};

/// Selection of the sites to compare.
struct Scope
{
  /// True for sheets that overlap in part, such as half of a continuum sheet and a whole lattice: bounds may differ,
  /// and parts of each sheet may be missing in the other.
  bool is_overlap = false;
  std::vector<Circle> excluded; ///< circles whose sites are not compared, for example around the tip of a crack
};

/// Fields and differences at the sites.
struct Comparison
{
  SiteValues continuum;                 ///< the finite element fields at the sites
  std::vector<std::uint8_t> complete;   ///< 1 at sites with all bonds, that is, the maximum number of bonds of a site
  std::vector<std::uint8_t> excluded;   ///< 1 at sites within an excluded circle
  std::vector<FieldValues> differences; ///< lattice minus continuum; NaN at sites outside

  /// Returns the sites at which a field is compared: free, inside, not excluded, and complete for fields from bonds.
  std::vector<std::size_t> compared(const LatticeFrame &lattice, const CommonField &field) const;
};

/// Evaluates the continuum at the sites and computes the differences. Collective; the result does not depend on the
/// number of ranks.
/// @throws InputError if a part of one sheet is missing in the other (a hole) and the scope is not an overlap, if no
/// site can be compared, or if a field seems to have other units: 100, 1000, 1e6 ... times that of the other, to 5 %
Comparison compare(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Scope &scope,
                   MPI_Comm communicator);

/// Returns rows on the compared sites, a row on whether the sheets have the same load, followed by a row for the
/// largest and a row for the root-mean-square difference of each field. The loads are the same if held sites of the
/// lattice on edges of the continuum have the same displacement on both sides to 1e-4 of the largest; sheets without
/// such sites have no such row. Both are relative to the larger of the corresponding norms of the two sides, which are
/// in the columns `lattice` and `continuum`. The norm of tensors and vectors is the root of the sum of squares of their
/// in-plane components, for deformation_gradient of F - 1.
/// @param tolerances tolerances of the root-mean-square differences by field; fields without a tolerance are only
/// reported
/// @throws InputError if there is a tolerance for a field that is not compared
output::Results norms(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Comparison &comparison,
                      const std::map<std::string, double> &tolerances);

} // namespace latcon::compare
