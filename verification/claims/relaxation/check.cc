#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/relaxation/relaxation_claim.h"

namespace latcon::claims
{

ClaimOutcome check_relaxation(const ClaimInput &input)
{
  RelaxationOptions options;
  if (!input.quick)
    options.max_steps = 100000;
  return relaxation_claim(input.subject, options);
}

} // namespace latcon::claims
