#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `relaxation`.
[[nodiscard]] Claim relaxation_descriptor();

} // namespace latcon::claims
