#include "verification/claims/relaxation/descriptor.h"

#include "verification/claims/relaxation/relaxation_claim.h"

namespace latcon::claims
{
namespace
{

ClaimOutcome check(const ClaimInput &input)
{
  RelaxationOptions options;
  if (!input.quick)
    options.max_steps = 100000;
  return relaxation_claim(input.subject, options);
}

} // namespace

Claim relaxation_descriptor()
{
  Claim claim;
  claim.name = "relaxation";
  claim.title = "a strained sheet relaxes as its relaxation spectrum predicts";
  claim.statement =
    "Stress and energies of a sheet that is strained suddenly and then held are sums of exponentials, one for each "
    "Maxwell branch of the bonds, in the lattice and in finite elements. A material without branches is given three of "
    "them.";
  claim.check = check;
  const std::string strained = ": held sheet after a step of strain, ", held = strained + "velocity Verlet, ",
                    elements = strained + "finite elements, ";
  claim.required_rows = {
    held + "first Piola stress, worst of all times, error over the overstress at the start",
    held + "energy stored in a branch, worst of all branches and times, error over that at the start",
    held + "energy dissipated by a branch, worst of all branches and times",
    held + "branches against the totals of the energy ledger, worst of all times, error over their energy at the start",
    held + "energy imbalance, worst of all times, over the energy of the branches at the start",
    elements + "first Piola stress, worst of all times, error over the overstress at the start",
    elements + "energy stored in a branch, worst of all branches and times, error over that at the start",
    elements + "energy dissipated by a branch, worst of all branches and times, error over that stored at the start",
    elements +
      "branches against the totals of the energy ledger, worst of all times, error over their energy at the start",
    elements + "energy imbalance, worst of all times, over the energy of the branches at the start"};
  claim.is_about_memory = true;
  return claim;
}

} // namespace latcon::claims
