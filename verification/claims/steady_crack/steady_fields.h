#pragma once

#include <vector>

#include "verification/claims/steady_crack/half_strip.h"

namespace latcon::claims
{

/// Fields around a steadily running crack as functions of the time s since a bond across it broke.
/// Elongations are over the breaking elongation.
struct SteadyFields
{
  double driving;                 ///< Delta / Delta_G
  std::vector<double> time;       ///< s, even steps, in sqrt(m/k)
  std::vector<double> elongation; ///< of a bond across the crack, or of the gap it leaves
  double largest_before;    ///< of a bond across the crack until a tenth of the breaking interval before it breaks
  double largest_elsewhere; ///< of any other bond at any time
  double dissipation;       ///< by all dashpots for one broken bond, over the energy k e_c^2 / 2 that this held

  /// Returns whether the solution is valid: bonds reach the breaking elongation when they are to break, and nowhere
  /// else.
  bool exists() const { return largest_before < 1. && largest_elsewhere < 1.; }
};

/// The fields by inverse Fourier transform of the exact solution (theory-comparison.md, eqs. (S.6) and (S.7)).
/// @param duration of the periodic record, half of it ahead of the breaking: long enough for all motion behind the
/// crack to die out, in sqrt(m/k)
/// @param samples of it, a power of 2; errors fall with the second power of the step
SteadyFields steady_fields(const CrackStrip &strip, double speed, double duration, std::size_t samples);

} // namespace latcon::claims
