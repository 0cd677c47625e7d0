#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `wave-speeds`.
[[nodiscard]] Claim wave_speeds_descriptor();

} // namespace latcon::claims
