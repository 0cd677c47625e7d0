#pragma once

#include "verification/claims/claim.h"

namespace latcon::claims
{

/// Descriptor of the claim `viscoelastic-waves`.
[[nodiscard]] Claim viscoelastic_waves_descriptor();

} // namespace latcon::claims
