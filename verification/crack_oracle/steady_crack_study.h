#pragma once

#include "verification/claim_outcome.h"

namespace verification
{

/// Steady cracks of the simulator against the exact solution of the linear lattice (theory-comparison.md, section "A
/// steady crack in a linear lattice"): speed, elastic energy released and energy dissipated for each broken bond (eq.
/// (S.9)), under several drivings and for a weak and a strong viscosity. Besides, the exact solution against the
/// equilibrium of a crack at rest.
///
/// Leaves the tables `steady_crack` (a row for each run) and, unless `quick`, `steady_crack_curve` (exact driving over
/// speed, and whether only the bonds that should break do).
/// @param quick fewer drivings; about 25 s on one core, in full 60 s
ClaimOutcome steady_crack_study(bool quick);

} // namespace verification
