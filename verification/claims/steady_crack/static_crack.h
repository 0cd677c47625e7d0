#pragma once

#include "verification/claims/steady_crack/half_strip.h"

namespace latcon::claims
{

/// Drivings Delta / Delta_G between which a crack at rest neither opens nor heals: lattice trapping
/// (theory-comparison.md, eq. (S.10)).
struct TrappingWindow
{
  double heals;  ///< Delta_-: here the last broken bond would be at the breaking elongation, were it whole
  double starts; ///< Delta_+: here the first bond ahead reaches it
};

/// The window from the equilibrium of a strip with a half-infinite crack, a sparse linear system. The viscosity has no
/// part in it.
/// @param columns sites in a row, half of them ahead of the tip; the ends are free. Errors fall exponentially with the
/// length over the height: sixteen times the layers leave less than 1e-6
/// @throws std::runtime_error if the system cannot be solved
TrappingWindow trapping_window(const CrackStrip &strip, std::size_t columns);

} // namespace latcon::claims
