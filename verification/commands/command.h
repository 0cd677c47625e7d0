#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "support/errors.h"
#include "support/folder_lock.h"
#include "verification/bridge/laws.h"
#include "verification/claims/claim.h"
#include "verification/claims/rows.h"
#include "verification/input/case.h"
#include "verification/input/options.h"
#include "verification/output/results.h"
#include "verification/output/run_info.h"
#include "verification/resources/resources.h"

namespace latcon::analysis
{
struct CrackMeasurement;
}

namespace latcon::output
{
class Checkpoints;
}

namespace latcon::commands
{

/// All claims, in the order in which they are checked and shown.
[[nodiscard]] const std::vector<claims::Claim> &claim_registry();

/// Claims checked by `latcon verify` for these names on the command line; without names the default ones.
/// @param names of the registry, in any order
/// @param material of the lattice
[[nodiscard]] std::vector<claims::Claim> selected_claims(const std::vector<std::string> &names,
                                                         const lattice::Material &material);

/// Claims that must hold before a crack is run. @param material of the sheet that breaks @param on_continuum whether it
/// is the continuum in place of the lattice
[[nodiscard]] std::vector<claims::Claim> claims_before_fracture(const lattice::Material &material,
                                                                bool on_continuum = false);

/// Message about a name that is not in the registry, with the nearest name that is; empty if it is in.
[[nodiscard]] std::string unknown_claim(const std::string &name);

/// Names of all claims as the help shows them: "{energy,wave-speeds}".
[[nodiscard]] std::string claim_choices();

/// A line for each claim, with its title, for the help.
[[nodiscard]] std::string claim_list();

/// Writes claims.json, titles and statements for the report, into `folder`, which must exist. @throws OutputError
void write_claims(const std::vector<claims::Claim> &claims, const std::string &folder);

// The commands. Each runs on every MPI rank and returns the exit code of the program, or throws.
support::ExitCode verify(const input::Options &options);        ///< `latcon verify`
support::ExitCode run_lattice(const input::Options &options);   ///< `latcon lattice`
support::ExitCode run_continuum(const input::Options &options); ///< `latcon continuum`
support::ExitCode run_fracture(const input::Options &options);  ///< `latcon fracture`
support::ExitCode print_schema(const input::Options &options);  ///< `latcon schema`

/// `latcon study`, `batch`, `compare`, `report`, `entries`, `init`, and `help` on entries, which are Python: does not
/// return if it starts.
/// @param command which of them @param names paths of what it is about @param chosen its own options, by name
support::ExitCode continue_in_python(const input::Options &options, const std::string &command,
                                     const std::vector<std::string> &names, nlohmann::ordered_json chosen);

/// Declared entries, shipped cases and claims as JSON; with a case its values.
[[nodiscard]] nlohmann::ordered_json schema_document(const input::Options &options);
/// `latcon resolve`: a line of JSON with the schema, cores and record of the program, then one for each line on
/// standard input, which asks for the base case to be read ("base"), for the nearest of some words, numbers in SI
/// units, the memory of runs, or a case with some changes: its cost, values and hashes, or its text. Problems are
/// answers.
support::ExitCode resolve_cases(const input::Options &options);
/// `latcon gate`: checks the claims that a crack waits for, see require_verified(). @throws ClaimFailed
support::ExitCode verify_before_cracks(const input::Options &options);

/// Draws pictures and report.html of a run in a directory that this process has locked, without a word. On rank 0.
/// @param shows_progress whether a progress line is shown meanwhile
/// @return the exit code of the script @throws OutputError
support::ExitCode draw_report(const std::string &directory, bool shows_progress);

/// Reads and checks the case that the options name; parameters.finish() throws its problems. Collective.
void read_case(const input::Options &options, input::Case &input, input::Parameters &parameters);

/// Returns whether the number of threads is left to the program: neither --threads nor OMP_NUM_THREADS is given.
bool has_default_threads(const input::Options &options);

/// Prints a part of the output of --dry-run, on the root rank, unless --quiet.
void print_dry_run(const input::Options &options, const std::string &text);

/// Refuses a run that takes longer than 10 days, unless the user confirmed it. @param seconds estimated
/// @throws InputError with the estimate
void require_time(const input::Options &options, double seconds);

/// Refuses a run of the lattice that needs too much memory or time, unless the user confirmed it, and prints what
/// --dry-run shows: the resolved case, memory, sites, bonds, time step, stages, steps and estimated time. Collective.
/// @return whether it is to be run; false with --dry-run
[[nodiscard]] bool is_to_be_run(const input::Options &options, const input::Parameters &parameters,
                                const input::Case &input, const lattice::TimeStepping &stepping,
                                resources::RunKind run);

/// Number of checks that hold and fail, a line for each claim.
[[nodiscard]] std::string claim_lines(const output::Results &results);

/// Seconds of each phase: "claims 8.1 s, fracture 61 s".
[[nodiscard]] std::string times_text(const std::vector<std::pair<std::string, double>> &times);

/// Summary of a crack for the terminal, in lines of 120 columns: its pattern with the criterion, measured quantities
/// with uncertainties and, if the case has any, reference values, a line for each claim, and rows that fail. At most a
/// dozen lines if none fails.
[[nodiscard]] std::string crack_summary(const input::Case &input, const analysis::CrackMeasurement &crack,
                                        const output::Results &results);

/// Output directory of a run, locked until the run has ended, and its provenance. Rank 0 alone writes.
/// Until the program ends, run.json gets its exit code however it ends: see record_exit_code().
class Run
{
public:
  /// Creates and locks the directory, moves files of an earlier run aside (see output_file.h) unless this one continues
  /// from a checkpoint, and writes case.prm and run.json. To be constructed once the input is known to be valid.
  /// @param parameters of its case; null: none, and no case.prm @param checkpoints null: it has none
  /// @throws InputError if another process writes to the directory, or case.prm would replace the user's own case:
  /// nothing is written then @throws OutputError
  Run(const input::Options &options, const input::Parameters *parameters,
      const output::Checkpoints *checkpoints = nullptr);

  const std::string &directory() const { return directory_; }
  output::RunInfo &info() { return record_->info; }
  bool is_root() const { return is_root_; } ///< true on rank 0
  /// Returns whether to print: on rank 0, unless --quiet.
  bool is_verbose() const { return is_verbose_; }
  bool has_default_threads() const { return has_default_threads_; } ///< see commands::has_default_threads()

  /// Writes results.json, results.csv and the final run.json, and prints the rows. Of many rows it prints the number of
  /// each claim and those that fail, unless --verbose.
  support::ExitCode finish(const output::Results &results);

  /// Writes results.json, results.csv and the final run.json, prints nothing. @return `exit_code`
  support::ExitCode end(const output::Results &results, support::ExitCode exit_code);

private:
  void record_checkpoint(const output::Checkpoints &checkpoints);
  // Moves the files of an earlier run aside, unless this run resumes.
  void clear(const input::Options &options) const;
  void print(const output::Results &results) const;

  struct Record
  {
    explicit Record(const input::Options &options) : directory(options.output_dir), info(options.arguments) {}
    void write(std::optional<support::ExitCode> with) const; // also the log
    void write_log() const;

    std::string directory;
    std::unique_ptr<support::FolderLock> lock; // on rank 0
    output::RunInfo info;
    std::string verdict;
    std::optional<support::ExitCode> exit_code; // the one written last
    std::string log_header;                     // what precedes the output of this program in log.txt
    std::string log_end;                        // the message that it ends with, if any
    bool keeps_log = true;                      // false if standard output is log.txt already
  };
  void begin_log(const input::Options &options);
  friend void record_exit_code(support::ExitCode exit_code, const std::string &message);
  static std::shared_ptr<Record> last; // on rank 0, the record of the last run that began

  std::shared_ptr<Record> record_;
  std::string directory_;
  bool is_root_, is_verbose_, prints_all_, resumes_, has_default_threads_;
};

/// Writes the exit code of the program into run.json, and its output into log.txt, of the run that began, if any, and
/// releases the run. To be called once signals have no effect.
/// @param message printed to standard error, if any @throws OutputError
void record_exit_code(support::ExitCode exit_code, const std::string &message = {});

/// Exit code of a program that was stopped by a signal or, otherwise, whose results alone decide.
support::ExitCode exit_code_of(const output::Results &results);

/// Keeps the verdicts of a claim in its small version for the cracks of this program, if it is about the program alone.
/// To be called by one rank. @return why they are not kept; empty: no problem
std::string keep_for_cracks(const input::Case &input, const claims::Claim &claim, const claims::ClaimOutcome &outcome);

/// Checks the claims, in their small versions, on the case's own material, shells and pre-stretch, or reuses the
/// verdicts cached for exactly these inputs and this program. Reports which of the two, in words and in run.json, and
/// writes the tables. Collective; all ranks return the same.
/// @param claims those that the crack depends on @param laws that are judged; rows about others are reported
/// @return the rows, at least one of them checked and none failing
/// @throws ClaimFailed that names the rows which fail, if any; results.json and run.json are then written
output::Results require_verified(const input::Case &input, const std::vector<claims::Claim> &claims,
                                 const bridge::Laws &laws, Run &run);

} // namespace latcon::commands
