#include "verification/bridge/damaged_sheet.h"
#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/damage/damage_claim.h"

namespace latcon::claims
{

ClaimOutcome check_damage(const ClaimInput &input)
{
  DamageOptions options;
  options.finest = input.quick ? 4 : 8;
  return damage_claim(input.subject, bridge::damage_law(input.entries, input.subject), options);
}

} // namespace latcon::claims
