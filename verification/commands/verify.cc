#include <nlohmann/json.hpp>

#include "verification/claims/claim_inputs.h"
#include "verification/claims/verdict_store.h"
#include "verification/commands/command.h"
#include "verification/elements/elements.h"

namespace latcon::commands
{

support::ExitCode verify(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  claims::check_user_laws(input, parameters);
  parameters.finish();
  if (options.dry_run)
  {
    print_dry_run(options, parameters.resolved_text());
    return support::ExitCode::done;
  }
  Run run(options, &parameters);
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
      claims::ClaimOutcome found = elements::elements().run_claims(
        input, {claim}, options.quick, claims::Shells::own_and_nearest,
        options.laws_of_case ? bridge::laws_of(input) : bridge::all_laws(), run.is_root() ? run.directory() : std::string());
      if (!options.claims.empty() && found.results.verdict() == output::Verdict::reported)
        found.results.add(output::not_computed(claim.name, "rows that are judged",
                                               "this case has none; a claim that is named must judge something"));
      if (run.is_root() && options.quick)
        if (const std::string note = keep_for_cracks(input, claim, found); !note.empty() && run.is_verbose())
          std::cout << note << std::endl;
      outcome.add(found);
      // Kept if a signal ends one of the following claims.
      if (run.is_root())
      {
        claims::Verdicts(outcome).write_tables(run.directory());
        outcome.results.write(run.directory());
      }
    }
  }
  return run.finish(outcome.results);
}

} // namespace latcon::commands
