#include "verification/claims/wave_speeds/descriptor.h"

#include "verification/claims/stability_row.h"
#include "verification/claims/wave_speeds/wave_speeds_claim.h"
#include "verification/claims/wave_states.h"

namespace latcon::claims
{
namespace
{

ClaimOutcome check(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  WaveSpeedsOptions options;
  options.states = wave_states(subject, input.quick);
  options.damped_states = wave_states(subject, true);
  if (input.quick)
  {
    options.kd = {0.1, 0.5};
    options.mesh.cells = 4;
    options.damped_states = {options.states.back()};
  }
  ClaimOutcome outcome = wave_speeds_claim(subject, options);
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "wave-speeds"));
  return outcome;
}

} // namespace

Claim wave_speeds_descriptor()
{
  Claim claim;
  claim.name = "wave-speeds";
  claim.title = "waves travel at the same speed and decay at the same rate";
  claim.statement =
    "Waves in the lattice and in the finite elements follow the closed-form dispersion relations, in an "
    "undeformed and in a stretched sheet.";
  claim.check = check;
  claim.required_rows = {", F = I: long-wave speed, L, lattice run against closed form, worst of 4 directions",
                         ", F = I: long-wave speed, S, lattice run against closed form, worst of 4 directions",
                         ", F = I: phase velocity, lattice run against Bloch, worst of all waves",
                         ", F = I: phase velocity, finite elements against their continuum, worst of all waves",
                         ", F = I: phase velocity at kd = 0.25, gradient continuum against Bloch, worst of all waves",
                         ", F = I: order in kd of the local continuum's error, all waves together",
                         ", F = I: order in kd of the gradient continuum's error, all waves together"};
  return claim;
}

} // namespace latcon::claims
