#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/disorder/disorder_claim.h"

namespace latcon::claims
{

ClaimOutcome check_disorder(const ClaimInput &input)
{
  DisorderOptions options;
  options.disorder = input.entries.disorder.disorder();
  if (!input.quick)
  {
    options.n_sheets = 64;
    options.columns = 48;
  }
  return disorder_claim(input.subject, options);
}

} // namespace latcon::claims
