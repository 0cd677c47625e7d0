#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <deal.II/base/mpi.h>

#include "verification/bridge/subject.h"
#include "verification/claims/gate_rows.h"
#include "verification/claims/verdict_store.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"

namespace latcon::commands
{
namespace
{

constexpr bool quick = true; // a few seconds before every crack

// Cached verdicts, as found by the root rank.
struct Stored
{
  std::string key;  // inputs that the verdicts depend on; empty: not known
  std::string text; // content of the stored file; empty: none that can be read
  std::string note; // message for the user; empty: no problem
  std::unique_ptr<claims::VerdictStore::Turn> turn = nullptr; // of the root rank, to check the claims
};

std::string unused(const std::string &path, const std::string &reason)
{
  return path + " is not used: " + reason;
}

Stored look_up(const input::Case &input, const std::vector<claims::Claim> &required, const bridge::Laws &laws,
               const std::optional<std::string> &folder)
{
  Stored stored;
  try
  {
    const claims::VerdictKey key =
      claims::verdict_key(input, required, laws, quick, dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    stored.key = key.text;
    if (!folder)
      stored.note = "neither XDG_CACHE_HOME nor HOME is set: no verdicts are kept";
    else
      try
      {
        const claims::VerdictStore store(*folder);
        stored.text = store.read(key).value_or("");
        if (stored.text.empty())
        {
          stored.turn = store.wait_for_turn(key);
          stored.text = store.read(key).value_or(""); // by the process that had its turn before
        }
      }
      catch (const claims::UnusableVerdicts &error)
      {
        stored.note = unused(claims::VerdictStore(*folder).path(key), error.what());
      }
  }
  catch (const std::exception &error)
  {
    stored.note = std::string("no verdicts are kept: ") + error.what();
  }
  return stored;
}

// Returns the same on all ranks.
Stored look_up_on_root_rank(const input::Case &input, const std::vector<claims::Claim> &required,
                            const bridge::Laws &laws, const Run &run, const std::optional<std::string> &folder)
{
  Stored stored = run.is_root() ? look_up(input, required, laws, folder) : Stored();
  const auto shared = [](const std::string &text) { return dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, text); };
  return {shared(stored.key), shared(stored.text), shared(stored.note), std::move(stored.turn)};
}

void append(std::string &note, const std::string &more)
{
  note += (note.empty() ? "" : "; ") + more;
}

} // namespace

output::Results require_verified(const input::Case &input, const std::vector<claims::Claim> &required,
                                 const bridge::Laws &laws, Run &run)
{
  const auto phase = run.info().stopwatch().phase("claims");
  const std::optional<std::string> folder = claims::VerdictStore::folder_of_user();
  Stored stored = look_up_on_root_rank(input, required, laws, run, folder);
  const claims::VerdictKey key(stored.key);
  const std::string path = folder ? claims::VerdictStore(*folder).path(key) : "";

  std::optional<claims::Verdicts> verdicts;
  if (!stored.text.empty())
    try
    {
      verdicts = claims::read_verdicts(key, stored.text);
      // Verdicts that refuse a crack need not be complete.
      if (const std::string problem =
            claims::row_problem(verdicts->results, bridge::shells_name(input.material()), required);
          verdicts->results.all_hold() && !problem.empty())
      {
        verdicts.reset();
        throw claims::UnusableVerdicts("its rows are not those of the claims: " + problem);
      }
    }
    catch (const claims::UnusableVerdicts &error)
    {
      append(stored.note, unused(path, error.what()));
    }
  const bool reused = verdicts.has_value();
  bool kept = false;
  if (!reused)
  {
    verdicts.emplace(run_claims(input, required, quick, Shells::own, laws));
    if (run.is_root() && folder && !key.text.empty())
      try
      {
        claims::VerdictStore(*folder).write(key, claims::verdicts_text(key, *verdicts));
        kept = true;
      }
      catch (const support::OutputError &error)
      {
        append(stored.note, std::string("the verdicts are not kept: ") + error.what());
      }
  }

  stored.turn.reset();

  output::RunInfo::Object record{
    {"hash", key.text.empty() ? "" : key.hash}, {"reused", reused}, {"checked_at", verdicts->checked_at}};
  if (!stored.note.empty())
    record.emplace_back("note", stored.note);
  run.info().add("verification", record);
  const std::string origin = reused ? "verdicts of " + verdicts->checked_at + ", hash " + key.hash + ", reused"
                                    : "checked now" + (kept ? ", hash " + key.hash + ", kept" : std::string());
  if (run.is_verbose())
  {
    if (!stored.note.empty())
      std::cout << "claims: " << stored.note << "\n";
    std::cout << "claims: " << origin << std::endl;
  }
  if (run.is_root())
  {
    write_claims(required, run.directory());
    verdicts->write_tables(run.directory());
  }
  if (!verdicts->results.all_hold())
  {
    run.end(verdicts->results, support::ExitCode::claim_failed);
    constexpr std::size_t most_failing_rows = 8;
    std::string rows = verdicts->results.verdict_text(most_failing_rows);
    rows.pop_back(); // the end of its last line
    throw support::ClaimFailed("no crack was run: the material and pre-stretch of this case fail their verification" +
                               (reused ? " (" + origin + "; to have them checked again, delete " + path + ")" : "") +
                               "\n" + rows);
  }
  return verdicts->results;
}

} // namespace latcon::commands
