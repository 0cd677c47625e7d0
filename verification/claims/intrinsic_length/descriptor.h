#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `intrinsic-length`.
[[nodiscard]] Claim intrinsic_length_descriptor();

} // namespace latcon::claims
