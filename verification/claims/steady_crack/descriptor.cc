#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim steady_crack_descriptor()
{
  Claim claim;
  claim.name = "steady-crack";
  claim.title = "cracks of the simulator are those of the exact solution";
  claim.statement =
    "Between linear bonds of nearest neighbours with Kelvin dashpots at infinitesimal strain a steady crack has an "
    "exact "
    "solution. In the same strip under the same load a crack of the simulator has its speed, and releases and "
    "dissipates as much energy for each broken bond. This claim is about the simulator alone, whatever the case.";
  claim.gate = true;
  claim.is_about_program = true;
  return claim;
}

} // namespace latcon::claims
