#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `steady-crack`.
[[nodiscard]] Claim steady_crack_descriptor();

} // namespace latcon::claims
