#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/running_crack/running_crack_claim.h"

namespace latcon::claims
{

ClaimOutcome check_running_crack(const ClaimInput &input)
{
  RunningCrackOptions options = input.quick ? RunningCrackOptions() : full_running_crack();
  options.frames = input.frames;
  return running_crack_claim(input.subject, options);
}

} // namespace latcon::claims
