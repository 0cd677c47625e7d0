#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim wave_speeds_descriptor()
{
  Claim claim;
  claim.name = "wave-speeds";
  claim.title = "waves travel at the same speed and decay at the same rate";
  claim.statement =
    "Waves in the lattice and in the finite elements follow the closed-form dispersion relations, in an "
    "undeformed and in a stretched sheet.";
  claim.gate = true;
  claim.entries = {"Time/integrator", "Fracture/left end", "Fracture/right end"};
  return claim;
}

} // namespace latcon::claims
