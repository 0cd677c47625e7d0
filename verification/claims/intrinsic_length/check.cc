#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

namespace latcon::claims
{

ClaimOutcome check_intrinsic_length(const ClaimInput &input)
{
  IntrinsicLengthOptions options;
  options.angle_step = input.quick ? 15. : 3.;
  return intrinsic_length_claim(input.subject, options);
}

} // namespace latcon::claims
