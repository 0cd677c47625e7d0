#pragma once

#include "continuum/damage/damage_law.h"
#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"

namespace latcon::claims
{

/// Sizes of the claim `damage`.
struct DamageOptions
{
  unsigned int finest = 4; ///< elements per xi of the finest bar, 4 or more and a power of two
  bool has_motion = true;  ///< false: without the rows about motion
  // For tests, errors of the finite elements that the theory does not have:
  double planted_toughness = 1.;            ///< factor of the threshold
  bool planted_healing = false;             ///< a homogeneous bar forgets its damage between load steps
  bool planted_undegraded_gradient = false; ///< damage leaves the gradient energy of a sheet as it is
};

/// Claim `damage`: bars of the subject's Cauchy-Born law in tension against closed forms (theory-damage.md, eqs.
/// (C.60) to (C.68)), without gradient energy and with the isotropic one; the degradation of the lattice's gradient
/// energy in a sheet; waves and a crack in motion (see add_damage_motion_rows).
///
/// Writes the table `damaged_bar`. Collective.
ClaimOutcome damage_claim(const bridge::Subject &subject, const continuum::DamageLaw &law,
                          const DamageOptions &options = DamageOptions());

} // namespace latcon::claims
