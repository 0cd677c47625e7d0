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
  claim.required_rows = {": alpha of L waves at 0 degrees, lattice run against closed form",
                         ": alpha of S waves at 0 degrees, lattice run against closed form",
                         ": alpha in all directions, Bloch against closed form",
                         ": alpha in all directions, gradient continuum against closed form",
                         ": softening: smallest alpha of any wave",
                         ": intrinsic length l_d, the longest bond over sqrt(12)",
                         ": shortest length with a positive gradient energy, against l_d, F = I",
                         ": the same 1 % below the shortest length: negative, F = I"};
  return claim;
}

} // namespace latcon::claims
