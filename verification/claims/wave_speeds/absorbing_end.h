#pragma once

#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Returns the rows of the claim `wave-speeds` on absorbing ends: of long waves an end reflects the share (Z - Z_end) /
/// (Z + Z_end) of the displacement, which is 0 where its impedance is that of the loaded sheet (theory.md, eq. (L.16)).
/// A pulse in the loaded sheet meets the right end; the integral of its displacement before and after is the share of
/// waves of infinite length, so that reflections of first order in k d, which the end has, drop out.
[[nodiscard]] output::Results absorbing_end_rows(const bridge::Subject &subject);

} // namespace latcon::claims
