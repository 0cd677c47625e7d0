#include <algorithm>
#include <functional>
#include <iostream>
#include <utility>

#include "verification/commands/command.h"
#include "verification/energy/energy_claim.h"
#include "verification/prestretch/cut_study.h"
#include "verification/prestretch/prestretch_claim.h"

namespace verification
{
namespace
{

ClaimOutcome energy(const Subject &subject, bool quick)
{
  return {energy_claim(subject, quick ? 200 : 2000), {}};
}

ClaimOutcome prestretch(const Subject &subject, bool quick)
{
  PrestretchOptions options;
  if (!quick)
  {
    options.length = 120.;
    options.height = 80.;
    options.cells_x = 24;
    options.cells_y = 16;
  }
  ClaimOutcome outcome{prestretch_claim(subject, options), {}};
  if (!subject.material.next_nearest)
  {
    outcome.add(cut_claim(subject, nearest_hole_study(quick)));
    return outcome;
  }
  outcome.add(cut_claim(subject, hole_study(quick)));
  outcome.add(cut_claim(subject, notch_study(quick)));
  if (!quick && (subject.deformation - Eigen::Matrix2d::Identity()).norm() > 0.01)
    outcome.add(cut_claim(subject, loaded_hole_study(subject.deformation)));
  return outcome;
}

using Claim = std::function<ClaimOutcome(const Subject &, bool)>;

// A further claim is a further line here.
const std::vector<std::pair<std::string, Claim>> &claims()
{
  static const std::vector<std::pair<std::string, Claim>> all{{"energy", energy}, {"prestretch", prestretch}};
  return all;
}

} // namespace

const std::vector<std::string> &claim_names()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> list;
    for (const auto &[name, claim] : claims())
      list.push_back(name);
    return list;
  }();
  return names;
}

ClaimOutcome run_claims(const Case &input, const std::vector<std::string> &names, bool quick)
{
  std::vector<Subject> subjects{subject(input)};
  if (input.has_next_nearest)
  {
    lattice::Material nearest_only = input.material();
    nearest_only.next_nearest.reset();
    subjects.push_back(subject(input, nearest_only));
  }
  ClaimOutcome outcome;
  for (const auto &[name, claim] : claims())
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end())
      for (const Subject &one : subjects)
        outcome.add(claim(one, quick));
  return outcome;
}

ExitCode verify(const Options &options)
{
  Case input;
  Parameters parameters;
  read_case(options, input, parameters);
  parameters.finish();
  if (options.dry_run)
  {
    if (!options.quiet)
      std::cout << parameters.resolved_text();
    return ExitCode::done;
  }
  Run run(options, parameters);
  ClaimOutcome outcome;
  {
    const auto phase = run.info().stopwatch().phase("claims");
    outcome = run_claims(input, options.claims, options.quick);
  }
  if (run.writes())
    outcome.write_tables(run.directory());
  return run.finish(outcome.results);
}

} // namespace verification
