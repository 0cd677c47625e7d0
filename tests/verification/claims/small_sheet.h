#pragma once

#include "verification/claims/prestretch/prestretch_claim.h"

namespace latcon::claims
{
/// Returns options of the claim `prestretch` for a sheet of 24 by 16 spacings, which takes a fraction of a second.
inline PrestretchOptions small_sheet()
{
  PrestretchOptions options;
  options.length = 24.;
  options.height = 16.;
  options.cells_x = 4;
  options.cells_y = 3;
  return options;
}
} // namespace latcon::claims
