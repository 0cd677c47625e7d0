#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim prestretch_descriptor()
{
  Claim claim;
  claim.name = "prestretch";
  claim.title = "stretched sheets agree, also around holes and notches";
  claim.statement = "Stretched between held edges, the relaxed lattice and the finite elements have the same energy, "
                    "tractions and fields.";
  claim.gate = true;
  return claim;
}

} // namespace latcon::claims
