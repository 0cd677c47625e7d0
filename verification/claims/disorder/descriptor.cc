#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim disorder_descriptor()
{
  Claim claim;
  claim.name = "disorder";
  claim.title = "a sheet with a little disorder has the moduli of its effective medium";
  claim.statement =
    "The bulk and the shear modulus of an undeformed sheet whose bonds differ in stiffness lie between the bounds of "
    "Voigt "
    "and Reuss, and their means over sheets are those of the effective medium. A case without such disorder is given "
    "some.";
  claim.is_about_disorder = true;
  claim.entries = {"Disorder/stiffness", "Disorder/stiffness width", "Disorder/seed"};
  return claim;
}

} // namespace latcon::claims
