#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim intrinsic_length_descriptor()
{
  Claim claim;
  claim.name = "intrinsic-length";
  claim.title = "the gradient continuum has the lattice's intrinsic length";
  claim.statement = "A lattice of spacing d has a length that the local continuum lacks.";
  claim.gate = true;
  return claim;
}

} // namespace latcon::claims
