#pragma once

#include <functional>
#include <optional>
#include <string>

#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Adds a row: quantity, value, theory, error and tolerance; numbers without unit.
using AddRow =
  std::function<void(const std::string &quantity, double value, double theory, const output::Tolerance &tolerance)>;

/// Rows of the claim `damage` about smooth deformations of a sheet at the strains of the case: nodal forces of the
/// Cauchy-Born law against the divergence of its stress, the order in h of these and of the forces of the lattice's
/// gradient energy, and the frequency of a wave with gradient energy and micro-inertia (theory-damage.md, eq. (C.82)).
void add_smooth_motion_rows(const bridge::Subject &subject, const AddRow &add);

} // namespace latcon::claims
