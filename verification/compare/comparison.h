/// A lattice frame beside a continuum frame of the same sheet: differences at the sites, and their norms.
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

/// How far a point may be off [m]: 1e-6 of the larger side of the sheet. vtu files hold positions in single precision
/// (6e-8), and meshes of other programs six digits (5e-7).
double position_tolerance(const ContinuumFrame &frame);

/// @throws InputError if one frame is of a motion and the other of an equilibrium, or their times differ by more than
/// time_tolerance, unless both times were asked for; the message has the times of both
void require_same_time(const LatticeFrame &lattice, const ContinuumFrame &continuum);

/// @throws InputError unless the undeformed sheets have the same bounds to position_tolerance(); the message says so if
/// one seems to be in other units, or if x and y seem to be exchanged
void require_same_bounds(const LatticeFrame &lattice, const ContinuumFrame &continuum);

/// A circle in the undeformed sheet.
struct Circle
{
  Position centre; ///< [m]
  double radius;   ///< [m] > 0
};

/// Which sites are compared.
struct Scope
{
  /// Sheets that cover each other in part, such as half a continuum beside a whole lattice: bounds may differ, and a
  /// part of either sheet may be missing in the other.
  bool is_overlap = false;
  std::vector<Circle> excluded; ///< no site within them is compared, such as those around the tip of a crack
};

/// What differs, at the sites.
struct Comparison
{
  SiteValues continuum;                 ///< the finite element fields at the sites
  std::vector<std::uint8_t> complete;   ///< 1 at sites that have all their bonds: as many as the site that has most
  std::vector<std::uint8_t> excluded;   ///< 1 at sites within an excluded circle
  std::vector<FieldValues> differences; ///< lattice less continuum; not-a-number at sites outside

  /// Sites whose values of a field are compared: free, inside, not excluded, and for fields from bonds complete.
  std::vector<std::size_t> compared(const LatticeFrame &lattice, const CommonField &field) const;
};

/// Evaluates the continuum at the sites and subtracts. Collective; the same bits on any number of ranks.
/// @throws InputError if a part of one sheet is missing in the other (a hole) and the scope is no overlap, if no site
/// can be compared, or if a field seems to be in other units: 100, 1000, 1e6 ... times that of the other to 5 %
Comparison compare(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Scope &scope,
                   MPI_Comm communicator);

/// A row for the largest and one for the root-mean-square difference of each field, both relative: to the larger of the
/// same norm of the two sides, which the columns `lattice` and `continuum` show. Tensors and vectors are measured by
/// the root of the sum of squares of their components in the plane, deformation_gradient as F - 1. Rows on what was
/// compared come first.
/// @param tolerances of the root-mean-square differences, by field; the fields without one are reported
/// @throws InputError if a tolerance is for a field that is not compared
output::Results norms(const LatticeFrame &lattice, const ContinuumFrame &continuum, const Comparison &comparison,
                      const std::map<std::string, double> &tolerances);

} // namespace latcon::compare
