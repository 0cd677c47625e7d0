#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `damage`.
[[nodiscard]] Claim damage_descriptor();

} // namespace latcon::claims
