#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim symmetry_descriptor()
{
  Claim claim;
  claim.name = "symmetry";
  claim.title = "rotations change neither energy nor stress";
  claim.statement = "Neither a rotation of the deformed sheet nor a rotation of the undeformed sheet by 60 degrees "
                    "changes its energy or its stress.";
  claim.gate = true;
  return claim;
}

} // namespace latcon::claims
