#include "verification/claims/energy/descriptor.h"

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
  claim.required_rows = {
    ": energy density, Cauchy-Born, largest relative error, 200 random F",
    ": first Piola stress, Cauchy-Born, largest relative error, 200 random F",
    ": mu at F = I, Cauchy-Born",
    ": lambda at F = I, Cauchy-Born",
    ": c_S at F = I, Cauchy-Born",
    ": c_L at F = I, Cauchy-Born",
    ", sinusoidal field about F = I: energy of the lattice against Bloch, worst of all fields",
    ", sinusoidal field about F = I: energy of the finite elements against their continuum, worst of all fields",
    ", sinusoidal field about F = I: order in kd to which local continuum and lattice agree",
    ", sinusoidal field about F = I: excess of the gradient continuum's energy over l_d^2 k^2 at kd = 0.05"};
  return claim;
}

} // namespace latcon::claims
