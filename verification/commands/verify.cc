#include <iostream>
#include <optional>

#include "support/one_thread.h"
#include "verification/bridge/subject.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"

namespace latcon::commands
{

claims::ClaimOutcome run_claims(const input::Case &input, const std::vector<claims::Claim> &claims, bool quick,
                                Shells shells, const bridge::Laws &laws, const std::string &frames)
{
  std::optional<support::OneThread> one_thread;
  if (quick)
    one_thread.emplace();
  const input::Case read = claims::claim_inputs(input);
  std::vector<bridge::Subject> subjects{subject(read, read.material(), laws)};
  if ((read.has_next_nearest || read.has_third_nearest) && shells == Shells::own_and_nearest)
  {
    lattice::Material nearest_only = read.material();
    nearest_only.next_nearest.reset();
    nearest_only.third_nearest.reset();
    subjects.push_back(subject(read, nearest_only, laws));
  }
  claims::ClaimOutcome outcome;
  for (const claims::Claim &claim : claims)
  {
    const input::Case entries = claims::claim_inputs(input, claim.entries);
    claims::ClaimOutcome found;
    for (const bridge::Subject &one : subjects)
      if (&one == &subjects.front() || (!claim.is_about_program && (!quick || !claim.quick_on_own_shells_only)))
        found.results.attempt(claim.name, one.name, [&] { found.add(claim.check({one, entries, quick, frames})); });
    if (claim.gate)
      found.results.mark_gate();
    outcome.add(found);
  }
  return outcome;
}

support::ExitCode verify(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  claims::check_user_laws(input, parameters);
  if (parameters.good())
    claims::check_user_laws_of(selected_claims(options.claims, input.material()), input, parameters);
  parameters.finish();
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text());
    return support::ExitCode::done;
  }
  Run run(options, parameters);
  run.info().add("laws", options.laws_of_case ? "case" : "all");
  if (run.is_verbose() && options.laws_of_case)
    std::cout << "Judged are the laws on which the case relies; --laws all judges every law of the continuum"
              << std::endl;
  claims::ClaimOutcome outcome;
  {
    const auto phase = run.info().stopwatch().phase("claims");
    const std::vector<claims::Claim> selected = selected_claims(options.claims, input.material());
    if (run.is_root())
      write_claims(selected, run.directory());
    for (const claims::Claim &claim : selected)
    {
      claims::ClaimOutcome found = run_claims(input, {claim}, options.quick, Shells::own_and_nearest,
                                              options.laws_of_case ? bridge::laws_of(input) : bridge::all_laws(),
                                              run.is_root() ? run.directory() : std::string());
      if (!options.claims.empty() && found.results.verdict() == output::Verdict::reported)
        found.results.add(output::not_computed(claim.name, "rows that are judged",
                                               "this case has none; a claim that is named must judge something"));
      outcome.add(found);
      // Kept if a signal ends one of the following claims.
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
