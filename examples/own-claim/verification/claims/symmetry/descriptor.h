#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `symmetry`.
[[nodiscard]] Claim symmetry_descriptor();

} // namespace latcon::claims
