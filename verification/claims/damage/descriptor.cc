#include "verification/claims/claim_list.h"

namespace latcon::claims
{

Claim damage_descriptor()
{
  Claim claim;
  claim.name = "damage";
  claim.title = "the continuum with damage breaks as predicted by closed forms";
  claim.statement = "Damage of the finite elements begins at its threshold, never heals, and closes the ledger of "
                    "energies. A bar breaks for the energy of a crack, with the damage of the closed form, with and "
                    "without gradient energy; in motion its crack runs if the energy that it releases exceeds that of "
                    "the crack. This claim is about the continuum alone.";
  claim.is_default = false;
  claim.gate = true;
  claim.is_about_damage = true;
  claim.entries = {"Damage/length", "Damage/threshold energy", "Damage/residual stiffness",
                   "Fracture/breaking stretch"};
  claim.quick_on_own_shells_only = true;
  claim.takes_user_laws = false; // the elements of an open crack are stretched by hundreds of critical strains
  return claim;
}

} // namespace latcon::claims
