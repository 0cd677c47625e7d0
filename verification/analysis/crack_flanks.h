#pragma once

#include <optional>
#include <vector>

#include "verification/analysis/crack_records.h"

namespace latcon::analysis
{

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
