#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `energy`.
[[nodiscard]] Claim energy_descriptor();

} // namespace latcon::claims
