#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `running-crack`.
[[nodiscard]] Claim running_crack_descriptor();

} // namespace latcon::claims
