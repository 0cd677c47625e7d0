#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `prestretch`.
[[nodiscard]] Claim prestretch_descriptor();

} // namespace latcon::claims
