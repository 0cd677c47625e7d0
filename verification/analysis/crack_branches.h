#pragma once

#include <vector>

#include "verification/analysis/crack_records.h"

namespace latcon::analysis
{

/// When the broken bonds of a sheet count as two cracks. Lengths in lattice spacings d.
struct BranchRule
{
  /// Width of the columns of X in which strands are told apart. Wide enough for a dozen broken bonds, narrow enough
  /// that an oscillating path (slope below 1) spreads over less than half of `gap` in one column.
  double column_width = 4.;
  /// Empty stretch of Y between two strands. Bonds that break in the wake lie within several d of the path; a branch at
  /// 30 degrees is past this after 9 d.
  double gap = 10.;
  /// Broken bonds per d of X that make a strand. A crack right through the lattice cuts at least 2 (nearest neighbours
  /// alone, along a row); half of it leaves room for ligaments. Loose debris has less.
  double bonds_per_spacing = 1.;
  /// Length of X over which two strands must run side by side without a break. Holes torn beside a crest of an
  /// oscillating path are shorter than half a wavelength, which is 8 d to 32 d in rubber; a branch goes on.
  double persistence = 20.;
  /// Gap that the strands must reach somewhere along that length: a branch moves away, a damaged band keeps its
  /// distance.
  double grown_gap = 15.;
};

/// Fraction of the columns between X_begin and X_end in which the crack runs in two or more strands.
///
/// In every column the Y of the broken bonds are sorted and parted at gaps; a strand is a group with enough bonds; a
/// column counts if it belongs to a run of columns with two or more strands that is long enough and opens enough.
/// @param breaks broken bonds in any order, may be empty
/// @param X_begin, X_end stretch looked at, reference [m]
/// @param lattice_spacing d [m], > 0
/// @return in [0, 1]; 0 where the stretch holds no whole column
/// @throws std::invalid_argument if it holds 1e9 columns or more
double branched_fraction(const std::vector<BreakRecord> &breaks, double X_begin, double X_end, double lattice_spacing,
                         const BranchRule &rule = {});

} // namespace latcon::analysis
