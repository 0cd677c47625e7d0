#pragma once

#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Adds rows of the claim `damage` about smooth deformations of a sheet at the strains of the case: nodal forces of the
/// Cauchy-Born law against the divergence of its stress, the order in h of these and of the forces of the lattice's
/// gradient energy, and the frequency of a wave with gradient energy and micro-inertia (theory-damage.md, eq. (C.82)).
void add_smooth_motion_rows(const bridge::Subject &subject, const Rows &rows);

} // namespace latcon::claims
