#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/stability_row.h"
#include "verification/claims/viscoelastic_waves/viscoelastic_waves_claim.h"
#include "verification/claims/wave_states.h"

namespace latcon::claims
{

ClaimOutcome check_viscoelastic_waves(const ClaimInput &input)
{
  ViscoelasticWavesOptions options;
  options.states = wave_states(input.subject, input.quick);
  if (!input.quick)
  {
    options.frequencies = {0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1., 1.25, 1.7, 2.5, 5., 10., 30.};
    options.element_frequencies = {0.1, 0.3, 1., 3., 10.};
    options.element_states = options.states.size();
  }
  ClaimOutcome outcome = viscoelastic_waves_claim(input.subject, options);
  if (!input.subject.is_stable())
    outcome.results.add(stability_row(input.subject, "viscoelastic-waves"));
  return outcome;
}

} // namespace latcon::claims
