#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim viscoelastic_waves_descriptor()
{
  Claim claim;
  claim.name = "viscoelastic-waves";
  claim.title = "a spectrum of relaxation times disperses and damps waves";
  claim.statement =
    "Waves in a lattice whose bonds have Maxwell branches, and in finite elements of its continuum, have the frequency "
    "and the decay of the complex modulus: "
    "their speed lies between the rubbery and the glassy limit, and they decay fastest at w tau near 1.";
  claim.gate = true;
  claim.is_about_memory = true;
  return claim;
}

} // namespace latcon::claims
