#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim energy_descriptor()
{
  Claim claim;
  claim.name = "energy";
  claim.title = "lattice and continuum store the same energy";
  claim.statement =
    "Wherever the deformation is homogeneous, a sheet of bonds and its continuum store the same energy, in J/m³ of the "
    "undeformed sheet, and have the same stress. The moduli and wave speeds at small strain follow from that.";
  claim.gate = true;
  claim.entries = {"Contact/present", "Contact/distance", "Contact/stiffness", "Contact/viscosity",
                   "Time/integrator", "Time/stages",      "Time/step",         "Time/safety factor"};
  return claim;
}

} // namespace latcon::claims
