#include "verification/claims/intrinsic_length/descriptor.h"

#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

namespace latcon::claims
{
namespace
{

ClaimOutcome check(const ClaimInput &input)
{
  IntrinsicLengthOptions options;
  options.angle_step = input.quick ? 15. : 3.;
  return intrinsic_length_claim(input.subject, options);
}

} // namespace

Claim intrinsic_length_descriptor()
{
  Claim claim;
  claim.name = "intrinsic-length";
  claim.title = "the gradient continuum has the lattice's intrinsic length";
  claim.statement = "A lattice of spacing d has a length that the local continuum lacks.";
  claim.check = check;
  claim.gate = true;
  return claim;
}

} // namespace latcon::claims
