#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim relaxation_descriptor()
{
  Claim claim;
  claim.name = "relaxation";
  claim.title = "a strained sheet relaxes as its relaxation spectrum predicts";
  claim.statement =
    "Stress and energies of a sheet that is strained suddenly and then held are sums of exponentials, one for each "
    "Maxwell branch of the bonds, in the lattice and in finite elements. A material without branches is given three of "
    "them.";
  claim.gate = true;
  claim.is_about_memory = true;
  return claim;
}

} // namespace latcon::claims
