#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/stability_row.h"
#include "verification/claims/wave_speeds/absorbing_end.h"
#include "verification/claims/wave_speeds/wave_speeds_claim.h"
#include "verification/claims/wave_states.h"

namespace latcon::claims
{

ClaimOutcome check_wave_speeds(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  WaveSpeedsOptions options;
  options.states = wave_states(subject, input.quick);
  options.damped_states = wave_states(subject, true);
  options.integrator = input.entries.integrator;
  if (input.quick)
  {
    options.kd = {0.1, 0.5};
    options.mesh.cells = 4;
    options.damped_states = {options.states.back()};
  }
  ClaimOutcome outcome = wave_speeds_claim(subject, options);
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "wave-speeds"));
  else if (input.entries.left_end == input::Case::End::absorbing ||
           input.entries.right_end == input::Case::End::absorbing)
    outcome.results.attempt("wave-speeds", subject.name + ": absorbing end",
                            [&] { outcome.results.add(absorbing_end_rows(subject)); });
  return outcome;
}

} // namespace latcon::claims
