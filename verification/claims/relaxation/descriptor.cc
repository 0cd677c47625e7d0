#include "verification/claims/relaxation/descriptor.h"

#include "verification/claims/relaxation/relaxation_claim.h"

namespace latcon::claims
{
namespace
{

ClaimOutcome check(const ClaimInput &input)
{
  RelaxationOptions options;
  if (!input.quick)
    options.max_steps = 100000;
  return relaxation_claim(input.subject, options);
}

} // namespace

Claim relaxation_descriptor()
{
  Claim claim;
  claim.name = "relaxation";
  claim.title = "a strained sheet relaxes as its relaxation spectrum predicts";
  claim.statement =
    "Stress and energies of a sheet that is strained suddenly and then held are sums of exponentials, one for each "
    "Maxwell branch of the bonds, in the lattice and in finite elements. A material without branches is given three of "
    "them.";
  claim.check = check;
  claim.gate = true;
  claim.is_about_memory = true;
  return claim;
}

} // namespace latcon::claims
