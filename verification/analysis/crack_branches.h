#pragma once

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

} // namespace latcon::analysis
