#include <algorithm>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "support/ranks.h"
#include "verification/claims/verdict_store.h"
#include "verification/commands/command.h"
#include "verification/elements/elements.h"
#include "verification/input/files.h"

namespace latcon::commands
{
namespace
{

constexpr bool quick = true; // a few seconds before every crack

// Verdicts that may be used, as found by the root rank.
struct Stored
{
  std::string key;  // inputs that the verdicts depend on; empty: not known
  std::string text; // of the verdicts; empty: none that can be used
  std::string note; // message for the user; empty: no problem
};

// Returns the text of a file of verdicts that may replace a check; empty: there is no file. Of verdicts that refuse a
// crack, rows may be missing. Throws UnusableVerdicts.
std::string usable_text(const std::string &file, const claims::VerdictKey &key,
                        const std::vector<claims::Claim> &required, const bool is_shipped)
{
  const std::optional<std::string> text = claims::stored_text(file);
  if (!text)
    return "";
  const claims::Verdicts verdicts = claims::read_verdicts(key, *text);
  if (is_shipped && !verdicts.results.all_hold())
    return ""; // only a check on this machine refuses a crack
  std::string problem = verdicts.library_problem(is_shipped);
  if (problem.empty() && verdicts.results.verdict() != output::Verdict::fails)
    problem = verdicts.acceptance_problem(required);
  if (!problem.empty())
    throw claims::UnusableVerdicts(problem);
  return *text;
}

Stored look_up(const input::Case &input, const std::vector<claims::Claim> &required, const bridge::Laws &laws,
               const std::optional<std::string> &folder)
{
  Stored stored;
  std::string file;
  try
  {
    const claims::VerdictKey key = claims::verdict_key(input, required, laws, quick, support::n_ranks());
    stored.key = key.text;
    try
    {
      stored.text = usable_text(claims::verdicts_file(input::data_folder() + "/verdicts", key), key, required, true);
    }
    catch (const claims::UnusableVerdicts &) // another BLAS, say: as if the program had been packed without
    {
    }
    if (!stored.text.empty())
      return stored;
    if (!folder)
      throw std::runtime_error("neither XDG_CACHE_HOME nor HOME is set");
    file = claims::verdicts_file(*folder, key);
    stored.text = usable_text(file, key, required, false);
  }
  catch (const claims::UnusableVerdicts &error)
  {
    stored.note = file + " is not used: " + error.what();
  }
  catch (const std::exception &error)
  {
    stored.note = std::string("no verdicts are kept: ") + error.what();
  }
  return stored;
}

// Keeps verdicts if there is a folder. @return why they could not be kept; empty: no problem
std::string keep(const claims::VerdictKey &key, const claims::Verdicts &verdicts,
                 const std::optional<std::string> &folder)
{
  try
  {
    if (folder)
      claims::store_verdicts(*folder, key, verdicts);
    return "";
  }
  catch (const support::OutputError &error)
  {
    return std::string("the verdicts are not kept: ") + error.what();
  }
}

// Checks claims, or reuses their verdicts; reports which of the two, and writes the tables.
// @return the rows, and an addition to the message that they do not hold
std::pair<output::Results, std::string> verified(const input::Case &input, const std::vector<claims::Claim> &required,
                                                 const bridge::Laws &laws, Run &run)
{
  const std::optional<std::string> folder = claims::verdicts_folder_of_user();
  Stored stored = run.is_root() ? look_up(input, required, laws, folder) : Stored();
  for (std::string *text : {&stored.key, &stored.text, &stored.note})
    *text = support::broadcast(*text);
  const claims::VerdictKey key(stored.key);
  const bool reused = !stored.text.empty();
  claims::Verdicts verdicts =
    reused ? claims::read_verdicts(key, stored.text)
           : claims::Verdicts(elements::elements().run_claims(input, required, quick, claims::Shells::own, laws, {}));
  bool kept = false;
  if (!reused)
  {
    if (verdicts.results.verdict() != output::Verdict::fails)
      if (const std::string problem = verdicts.acceptance_problem(required); !problem.empty())
        verdicts.results.add(output::not_computed(required.front().name, "rows that a crack waits for", problem));
    if (run.is_root() && !key.text.empty())
    {
      const std::string problem = keep(key, verdicts, folder);
      kept = folder && problem.empty();
      stored.note += (stored.note.empty() || problem.empty() ? "" : "; ") + problem;
    }
  }

  const bool about_program = required.front().is_about_program;
  nlohmann::ordered_json record = {
    {"hash", key.text.empty() ? "" : key.hash}, {"reused", reused}, {"checked_at", verdicts.checked_at}};
  if (!stored.note.empty())
    record["note"] = stored.note;
  run.info().add(about_program ? "verification_of_program" : "verification", record);
  const std::string origin = reused ? "verdicts of " + verdicts.checked_at + ", hash " + key.hash + ", reused"
                                    : "checked now" + (kept ? ", hash " + key.hash + ", kept" : std::string());
  if (run.is_verbose())
    for (const std::string &message : {stored.note, origin})
      if (!message.empty())
        std::cout << (about_program ? "program: " : "claims: ") << message << std::endl;
  if (run.is_root())
    verdicts.write_tables(run.directory());
  return {verdicts.results, !reused ? ""
                                    : " (" + origin + "; to have them checked again, delete " +
                                        claims::verdicts_file(folder.value_or(""), key) + ")"};
}

} // namespace

std::string keep_for_cracks(const input::Case &input, const claims::Claim &claim, const claims::ClaimOutcome &outcome)
{
  if (!claim.is_about_program)
    return "";
  try
  {
    return keep(claims::verdict_key(input, {claim}, {}, quick, support::n_ranks()), claims::Verdicts(outcome),
                claims::verdicts_folder_of_user());
  }
  catch (const std::exception &error)
  {
    return std::string("no verdicts are kept: ") + error.what();
  }
}

output::Results require_verified(const input::Case &input, const std::vector<claims::Claim> &required,
                                 const bridge::Laws &laws, Run &run)
{
  const auto phase = run.info().stopwatch().phase("claims");
  if (run.is_root())
    write_claims(required, run.directory());
  output::Results results;
  for (const bool about_program : {false, true})
  {
    std::vector<claims::Claim> part;
    std::copy_if(required.begin(), required.end(), std::back_inserter(part),
                 [&](const claims::Claim &claim) { return claim.is_about_program == about_program; });
    if (part.empty())
      continue;
    const auto [of_part, refusal] = verified(input, part, laws, run);
    results.add(of_part);
    if (of_part.all_hold())
      continue;
    run.end(results, support::ExitCode::claim_failed);
    constexpr std::size_t most_failing_rows = 8;
    std::string rows = results.verdict_text(most_failing_rows);
    rows.pop_back(); // the end of its last line
    throw support::ClaimFailed(std::string("no crack was run: ") +
                               (about_program ? "this program fails its verification"
                                              : "the material and pre-stretch of this case fail their verification") +
                               refusal + "\n" + rows);
  }
  return results;
}

} // namespace latcon::commands
