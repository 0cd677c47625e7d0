/// Broken bonds off the path of a crack: branches, and damage of the flanks.
#pragma once

#include <optional>
#include <vector>

#include "verification/analysis/crack_records.h"

namespace latcon::analysis
{

/// Criteria for counting the broken bonds of a sheet as two or more strands. Lengths in lattice spacings d.
struct BranchRule
{
  /// Width of the columns of X in which strands are separated. Wide enough for a dozen broken bonds, narrow enough that
  /// an oscillating path (slope below 1) covers less than half of `gap` in one column.
  double column_width = 4.;
  /// Empty interval of Y between two strands. Bonds that break in the wake lie within several d of the path; a branch
  /// at 30 degrees exceeds this gap after 9 d.
  double gap = 10.;
  /// Broken bonds per d of X in a strand. A crack that cuts the lattice completely breaks at least 2 (nearest
  /// neighbours only, along a row); half of that allows for ligaments. Loose debris has fewer.
  double bonds_per_spacing = 1.;
  /// Length of X over which two strands must run in parallel without interruption. Holes beside a crest of an
  /// oscillating path are shorter than half a wavelength, which is 8 d to 32 d in rubber; a branch continues.
  double persistence = 20.;
  /// Gap that the strands must reach somewhere along this length: a branch moves away, whereas a damaged band keeps its
  /// distance.
  double grown_gap = 15.;
};

/// Returns the fraction of the columns between X_begin and X_end in which the crack has two or more strands.
///
/// In every column the Y of the broken bonds are sorted and split at gaps; a group with enough bonds is a strand.
/// Columns count if they belong to a run of columns with two or more strands that is long enough and reaches a large
/// enough gap.
/// @param breaks broken bonds in any order, may be empty
/// @param X_begin, X_end interval, reference [m]
/// @param lattice_spacing d [m], > 0
/// @return in [0, 1]; 0 if the interval contains no whole column
/// @throws std::invalid_argument if the interval contains 1e9 columns or more
double branched_fraction(const std::vector<BreakRecord> &breaks, double X_begin, double X_end, double lattice_spacing,
                         const BranchRule &rule = {});

/// Damage beside the path of a crack.
///
/// The paper raises the breaking stretch "behind the crack to keep its back surface intact. But even with this, a
/// fraction of mass points will still detach from an oscillating crack": bonds break near the path, few beside it, and
/// none far from it.
struct FlankDamage
{
  double depth; ///< largest distance of a broken bond from the path, reference [m], >= 0
  double share; ///< share of the broken bonds that lie more than 6 d from the path [-], 0 to 1
};

/// Measures the damage of the flanks between X_begin and X_end, reference [m].
///
/// The path is the polyline through the positions of the tip; the distance of a bond is the distance of its midpoint
/// from the path.
/// @param tip record of the tip, X not decreasing @param breaks broken bonds in any order
/// @param spacing d [m], > 0
/// @return none if there is no record of the tip, or if no bond broke between X_begin and X_end
std::optional<FlankDamage> flank_damage(const std::vector<TipRecord> &tip, const std::vector<BreakRecord> &breaks,
                                        double X_begin, double X_end, double spacing);

} // namespace latcon::analysis
