#include "verification/claims/energy/descriptor.h"

#include "verification/claims/energy/contact_rows.h"
#include "verification/claims/energy/energy_claim.h"
#include "verification/claims/energy/wave_energy.h"
#include "verification/claims/stability_row.h"
#include "verification/claims/wave_states.h"

namespace latcon::claims
{
namespace
{

ClaimOutcome check(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  ClaimOutcome outcome{energy_claim(subject, input.quick ? 200 : 2000), {}};
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "energy"));
  if (input.entries.has_contact)
    outcome.results.attempt("energy", subject.name + ": contact",
                            [&] { outcome.results.add(contact_rows(subject, input.entries)); });
  WaveEnergyOptions options;
  options.states = wave_states(subject, true);
  if (input.quick)
    options.kd = {0.25, 0.5};
  outcome.add(wave_energy_claim(subject, options));
  return outcome;
}

} // namespace

Claim energy_descriptor()
{
  Claim claim;
  claim.name = "energy";
  claim.title = "lattice and continuum store the same energy";
  claim.statement =
    "Wherever the deformation is homogeneous, a sheet of bonds and its continuum store the same energy, in J/m³ of the "
    "undeformed sheet, and have the same stress. The moduli and wave speeds at small strain follow from that.";
  claim.check = check;
  claim.gate = true;
  claim.entries = {"Contact/present", "Contact/distance", "Contact/stiffness", "Contact/viscosity",
                   "Time/integrator", "Time/stages",      "Time/step",         "Time/safety factor"};
  return claim;
}

} // namespace latcon::claims
