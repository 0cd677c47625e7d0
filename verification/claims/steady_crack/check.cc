#include "verification/claims/claim_list.h"
#include "verification/claims/steady_crack/steady_crack_claim.h"

namespace latcon::claims
{

ClaimOutcome check_steady_crack(const ClaimInput &input)
{
  return steady_crack_claim(input.quick);
}

} // namespace latcon::claims
