#pragma once

#include "continuum/damage/damage_law.h"
#include "verification/bridge/subject.h"
#include "verification/claims/damage/damage_claim.h"

namespace latcon::claims
{

/// Adds the rows of the claim `damage` about motion (theory-damage.md, eqs. (C.69) to (C.74)): waves in a damaged
/// bar, smooth deformations (add_smooth_motion_rows), and a crack in a strip at small strain whose energy release is
/// known, on meshes of xi/2 and, if the claim is to be checked in full, xi/4 and xi/8. The time scale is that of the
/// waves; the viscosity is xi/(3 c) times the stiffness.
/// @param law length and residual stiffness; the threshold follows from the energy release
void add_damage_motion_rows(const bridge::Subject &subject, const continuum::DamageLaw &law,
                            const DamageOptions &options, ClaimOutcome &outcome);

} // namespace latcon::claims
