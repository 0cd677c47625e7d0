#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/energy/contact_rows.h"
#include "verification/claims/energy/energy_claim.h"
#include "verification/claims/energy/wave_energy.h"
#include "verification/claims/stability_row.h"
#include "verification/claims/wave_states.h"

namespace latcon::claims
{

ClaimOutcome check_energy(const ClaimInput &input)
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

} // namespace latcon::claims
