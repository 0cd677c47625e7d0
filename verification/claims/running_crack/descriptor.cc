#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim running_crack_descriptor()
{
  Claim claim;
  claim.name = "running-crack";
  claim.title = "fields around a crack driven at the same speed agree";
  claim.statement =
    "A straight crack is driven through lattice and continuum at the same speed. The tip of the local continuum is "
    "that of "
    "the lattice to half a spacing, and five spacings from it and beyond velocity and opening stress agree within the "
    "uncertainty that this leaves, at most 7 %. The opening of the flanks, the gradient continuum, and differences "
    "nearer "
    "to the tip are reported.";
  claim.is_default = false;
  claim.quick_on_own_shells_only = true;
  return claim;
}

} // namespace latcon::claims
