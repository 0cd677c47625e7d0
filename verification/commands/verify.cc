#include <algorithm>
#include <functional>
#include <iostream>
#include <optional>
#include <utility>

#include "support/one_thread.h"
#include "verification/claims/claim_inputs.h"
#include "verification/claims/energy/energy_claim.h"
#include "verification/claims/energy/wave_energy.h"
#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"
#include "verification/claims/prestretch/cut_study.h"
#include "verification/claims/prestretch/prestretch_claim.h"
#include "verification/claims/running_crack/running_crack_claim.h"
#include "verification/claims/stability_row.h"
#include "verification/claims/wave_speeds/wave_speeds_claim.h"
#include "verification/commands/command.h"

namespace latcon::commands
{
namespace
{

// The states about which waves are evaluated: at rest, stretched alike along both axes, and as the case is loaded,
// unless the lattice buckles there and has no waves.
std::vector<Eigen::Matrix2d> states(const bridge::Subject &subject, bool quick)
{
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  std::vector<Eigen::Matrix2d> list{I};
  if (!quick && !subject.deformation.isApprox(I, 1e-12))
    list.emplace_back(1.5 * I);
  if (subject.is_stable() && !subject.deformation.isApprox(I, 1e-12))
    list.push_back(subject.deformation);
  return list;
}

claims::ClaimOutcome energy(const bridge::Subject &subject, bool quick)
{
  claims::ClaimOutcome outcome{claims::energy_claim(subject, quick ? 200 : 2000), {}};
  if (!subject.is_stable())
    outcome.results.add(claims::stability_row(subject, "energy"));
  claims::WaveEnergyOptions options;
  options.states = states(subject, true);
  if (quick)
    options.kd = {0.25, 0.5};
  outcome.add(claims::wave_energy_claim(subject, options));
  return outcome;
}

claims::ClaimOutcome wave_speeds(const bridge::Subject &subject, bool quick)
{
  claims::WaveSpeedsOptions options;
  options.states = states(subject, quick);
  options.damped_states = states(subject, true);
  if (quick)
  {
    options.kd = {0.1, 0.5};
    options.mesh.cells = 4;
    options.damped_states = {options.states.back()};
  }
  claims::ClaimOutcome outcome = claims::wave_speeds_claim(subject, options);
  if (!subject.is_stable())
    outcome.results.add(claims::stability_row(subject, "wave-speeds"));
  return outcome;
}

claims::ClaimOutcome intrinsic_length(const bridge::Subject &subject, bool quick)
{
  claims::IntrinsicLengthOptions options;
  options.angle_step = quick ? 15. : 3.;
  return claims::intrinsic_length_claim(subject, options);
}

claims::ClaimOutcome prestretch(const bridge::Subject &subject, bool quick)
{
  claims::PrestretchOptions options;
  if (!quick)
  {
    options.length = 120.;
    options.height = 80.;
    options.cells_x = 24;
    options.cells_y = 16;
  }
  claims::ClaimOutcome outcome{claims::prestretch_claim(subject, options), {}};
  if (!subject.material.next_nearest)
  {
    outcome.add(claims::cut_claim(subject, claims::nearest_hole_study(quick)));
    if (!quick)
      outcome.add(claims::cut_claim(subject, claims::notch_study(false)));
    return outcome;
  }
  outcome.add(claims::cut_claim(subject, claims::hole_study(quick)));
  outcome.add(claims::cut_claim(subject, claims::notch_study(quick)));
  if (!quick && subject.is_stable() && (subject.deformation - Eigen::Matrix2d::Identity()).norm() > 0.01)
    outcome.add(claims::cut_claim(subject, claims::loaded_hole_study(subject.deformation)));
  return outcome;
}

claims::ClaimOutcome running_crack(const bridge::Subject &subject, bool quick, const std::string &frames)
{
  claims::RunningCrackOptions options = quick ? claims::RunningCrackOptions() : claims::full_running_crack();
  options.frames = frames;
  return claims::running_crack_claim(subject, options);
}

struct Claim
{
  std::string name;
  std::function<claims::ClaimOutcome(const bridge::Subject &, bool quick, const std::string &frames)> check;
  bool is_slow = false; ///< the quick version takes the shells of the case alone
};

Claim without_frames(const std::string &name, claims::ClaimOutcome (*check)(const bridge::Subject &, bool))
{
  return {name,
          [check](const bridge::Subject &subject, bool quick, const std::string &) { return check(subject, quick); }};
}

// A further claim is a further line here.
const std::vector<Claim> &claims()
{
  static const std::vector<Claim> all{without_frames("energy", energy),
                                      without_frames("wave-speeds", wave_speeds),
                                      without_frames("intrinsic-length", intrinsic_length),
                                      without_frames("prestretch", prestretch),
                                      {"running-crack", running_crack, true}};
  return all;
}

} // namespace

const std::vector<std::string> &claim_names()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> list;
    for (const Claim &claim : claims())
      list.push_back(claim.name);
    return list;
  }();
  return names;
}

const std::vector<std::string> &claims_before_fracture()
{
  static const std::vector<std::string> names{"energy", "wave-speeds", "intrinsic-length", "prestretch"};
  return names;
}

claims::ClaimOutcome run_claims(const input::Case &input, const std::vector<std::string> &names, bool quick,
                                Shells shells, const bridge::Laws &laws, const std::string &frames)
{
  std::optional<support::OneThread> one_thread;
  if (quick)
    one_thread.emplace();
  const input::Case read = claims::claim_inputs(input);
  std::vector<bridge::Subject> subjects{subject(read, read.material(), laws)};
  if (read.has_next_nearest && shells == Shells::own_and_nearest)
  {
    lattice::Material nearest_only = read.material();
    nearest_only.next_nearest.reset();
    subjects.push_back(subject(read, nearest_only, laws));
  }
  claims::ClaimOutcome outcome;
  for (const Claim &claim : claims())
    if (names.empty() || std::find(names.begin(), names.end(), claim.name) != names.end())
      for (const bridge::Subject &one : subjects)
        if (&one == &subjects.front() || !quick || !claim.is_slow)
          outcome.results.attempt(claim.name, one.name, [&] { outcome.add(claim.check(one, quick, frames)); });
  return outcome;
}

support::ExitCode verify(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  parameters.finish();
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text());
    return support::ExitCode::done;
  }
  Run run(options, parameters);
  claims::ClaimOutcome outcome;
  {
    const auto phase = run.info().stopwatch().phase("claims");
    for (const std::string &name : claim_names())
    {
      const std::vector<std::string> &asked = options.claims.empty() ? claims_before_fracture() : options.claims;
      if (std::find(asked.begin(), asked.end(), name) == asked.end())
        continue;
      outcome.add(run_claims(input, {name}, options.quick, Shells::own_and_nearest,
                             options.case_is_given ? bridge::laws_of(input) : bridge::all_laws(),
                             run.is_root() ? run.directory() : std::string()));
      // What is known if a signal ends the claims that follow.
      if (run.is_root())
      {
        outcome.write_tables(run.directory());
        outcome.results.write(run.directory());
      }
    }
  }
  return run.finish(outcome.results);
}

} // namespace latcon::commands
