#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `disorder`.
[[nodiscard]] Claim disorder_descriptor();

} // namespace latcon::claims
