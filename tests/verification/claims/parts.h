#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "verification/claims/energy/energy_claim.h"
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"
#include "verification/claims/nonlocal/nonlocal_claim.h"
#include "verification/claims/prestretch/prestretch_claim.h"
#include "verification/claims/wave_speeds/wave_speeds_claim.h"

/// Short versions of claims and of their parts, in which tests plant faults.
namespace parts
{

using States = std::vector<Eigen::Matrix2d>;

struct ClaimPart
{
  std::string name;
  std::function<latcon::output::Results(const latcon::bridge::Subject &)> check;
  friend std::ostream &operator<<(std::ostream &out, const ClaimPart &part) { return out << part.name; }
};

/// Options of the claim `wave-speeds` with undamped and damped waves in some states.
inline latcon::claims::WaveSpeedsOptions waves(const States &states, const States &damped_states = {})
{
  latcon::claims::WaveSpeedsOptions options;
  options.states = states;
  options.damped_states = damped_states;
  options.kd = {0.25, 0.5};
  options.mesh.cells = 4;
  return options;
}

/// The part of the claim `energy` on waves, in some states.
inline latcon::claims::ClaimOutcome energy_of_waves(const latcon::bridge::Subject &subject, const States &states)
{
  latcon::claims::WaveEnergyOptions options;
  options.states = states;
  options.kd = {0.25, 0.5};
  options.mesh.cells = 4;
  options.travelling_mesh.cells = 6;
  return wave_energy_claim(subject, options);
}

/// Options of the claim `nonlocal` with all stencils.
inline latcon::claims::NonlocalOptions nonlocal_options(const latcon::bridge::Subject &subject)
{
  latcon::claims::NonlocalOptions options;
  options.stencils = latcon::claims::fixed_stencils(subject);
  options.samples = 5;
  options.breaking_stretch = 3.05;
  return options;
}

inline const ClaimPart energy{"energy",
                              [](const latcon::bridge::Subject &s) { return latcon::claims::energy_claim(s, 50); }},
  intrinsic_length{"intrinsic-length", [](const latcon::bridge::Subject &s)
                   { return latcon::claims::intrinsic_length_claim(s, 30.).results; }};

/// In a sheet of 24 by 16 spacings, which takes a fraction of a second.
inline const ClaimPart prestretch{"prestretch", [](const latcon::bridge::Subject &s)
                                  {
                                    latcon::claims::PrestretchOptions options;
                                    options.length = 24.;
                                    options.height = 16.;
                                    options.cells_x = 4;
                                    options.cells_y = 3;
                                    return latcon::claims::prestretch_claim(s, options);
                                  }};

} // namespace parts
