/// The functions that check the claims of claim_table.inc.
#pragma once

#include "verification/claims/claim_input.h"
#include "verification/claims/claim_outcome.h"

namespace latcon::claims
{

#define LATCON_CLAIM(name, ...) [[nodiscard]] ClaimOutcome check_##name(const ClaimInput &input);
#include "verification/claims/claim_table.inc"
#undef LATCON_CLAIM

} // namespace latcon::claims
