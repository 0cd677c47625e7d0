#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "support/errors.h"
#include "support/folder_lock.h"
#include "verification/bridge/laws.h"
#include "verification/claims/rows.h"
#include "verification/input/case.h"
#include "verification/input/options.h"
#include "verification/output/results.h"
#include "verification/output/run_info.h"

namespace latcon::claims
{
struct Claim;
}

namespace latcon::output
{
class Checkpoints;
}

namespace latcon::commands
{

/// Options of `latcon compare`. Times are texts, with a unit or in s, or load factors; empty: the last frame.
struct CompareOptions
{
  std::string first, second; ///< frames, series or output directories; or output directories of two cracks
  std::string time;          ///< of both frames
  std::string lattice_time, continuum_time;
  std::vector<std::string> tolerances; ///< `FIELD=VALUE`
  bool overlap = false;                ///< whether the sheets may overlap only in part
  std::vector<std::string> excluded;   ///< `X,Y,R` of circles
};

/// Sweep on the command line in place of a study file.
struct SweepOptions
{
  std::vector<std::string> sweeps; ///< `Section/Name=START:STOP:COUNT` or `=VALUE,VALUE`; none: no sweep
  std::size_t seeds = 0;           ///< number of seeds of each case; 0: not given
};

/// Options of `latcon study`.
struct StudyOptions
{
  std::string study; ///< file, name of a shipped study, or case of a sweep
  SweepOptions sweep;
  std::string shard;    ///< `I/N`: run this share alone, without verdict; empty: run all
  bool collect = false; ///< run nothing, judge the runs of all shards
};

/// Options of `latcon batch`.
struct BatchOptions
{
  std::string study; ///< file, name of a shipped study, or case of a sweep
  SweepOptions sweep;
  bool slurm = false;              ///< write scripts for Slurm, the only batch system supported
  bool submit = false;             ///< pass the scripts to sbatch
  std::size_t tasks = 0;           ///< tasks of the job array; 0: one per run, at most 1000
  std::size_t cpus_per_task = 1;   ///< runs at once in each task
  std::string time = "1-00:00:00"; ///< limit per task, in the form of sbatch
  std::string partition;           ///< empty: the default of the cluster
};

/// Options of `latcon report`.
struct ReportOptions
{
  std::string directory;  ///< of a run, or of several
  bool animation = false; ///< draw animations of cracks as well
};

// The commands. Each runs on every MPI rank and returns the exit code of the program, or throws.
support::ExitCode verify(const input::Options &options);                                  ///< `latcon verify`
support::ExitCode run_lattice(const input::Options &options);                             ///< `latcon lattice`
support::ExitCode run_fracture(const input::Options &options);                            ///< `latcon fracture`
support::ExitCode compare(const input::Options &options, const CompareOptions &chosen);   ///< `latcon compare`
support::ExitCode report(const input::Options &options, const ReportOptions &chosen);     ///< `latcon report`
support::ExitCode run_study(const input::Options &options, const StudyOptions &chosen);   ///< `latcon study`
support::ExitCode write_batch(const input::Options &options, const BatchOptions &chosen); ///< `latcon batch`
support::ExitCode print_schema(const input::Options &options);                            ///< `latcon schema`

/// Declared entries, shipped cases and claims as JSON; with a case its values.
[[nodiscard]] nlohmann::ordered_json schema_document(const input::Options &options);
/// `latcon resolve`: a line of JSON with the schema, cores and record of the program, then one for each line on
/// standard input, which asks for the base case to be read ("base"), for the nearest of some words, numbers in SI
/// units, the memory of runs, or a case with some changes: its cost, values and hashes, or its text. Problems are
/// answers.
support::ExitCode resolve_cases(const input::Options &options);
/// `latcon gate`: checks the claims that a crack waits for, see require_verified(). @throws ClaimFailed
support::ExitCode verify_before_cracks(const input::Options &options);

/// `latcon entries`: lists the entries of a section, or of all if it is empty. @throws InputError for an unknown
/// section
support::ExitCode print_entries(const std::string &section);

/// `latcon help TOPIC` for a section or an entry. @param commands names of the commands, for typing errors
/// @throws InputError for an unknown topic
support::ExitCode print_topic(const std::string &topic, const std::vector<std::string> &commands);

/// `latcon init`: creates the folder and a commented case in it. @throws InputError if the case exists @throws
/// OutputError
support::ExitCode init(const input::Options &options, const std::string &directory);

/// Draws pictures and report.html of a run, or of a folder of several, in a directory that this process has locked. On
/// rank 0.
/// @param quiet whether the script prints nothing
/// @param shows_progress whether a progress line is shown meanwhile
/// @return the exit code of the script @throws OutputError
support::ExitCode draw_report(const std::string &directory, bool quiet, bool shows_progress = false);

/// Reads and checks the case that the options name; parameters.finish() throws its problems. Collective.
void read_case(const input::Options &options, input::Case &input, input::Parameters &parameters);

/// Returns whether the number of threads is left to the program: neither --threads nor OMP_NUM_THREADS is given.
bool has_default_threads(const input::Options &options);

/// Prints a part of the output of --dry-run, on the root rank, unless --quiet.
void print_dry_run(const input::Options &options, const std::string &text);

/// Locks an existing directory, and removes the unfinished files that killed runs left in it and in its checkpoints.
/// Waits up to `patience` for another process to end.
/// @throws InputError if another process writes there @throws support::OutputError
std::unique_ptr<support::FolderLock> lock_directory(const std::string &directory,
                                                    std::chrono::milliseconds patience = std::chrono::seconds(1));

/// Output directory of a run, locked until the run has ended, and its provenance. Rank 0 alone writes.
///
/// Until the program ends, run.json gets its exit code however it ends: see record_exit_code().
class Run
{
public:
  /// Creates and locks the directory, moves files of an earlier run aside (see output_list.h) unless this one resumes,
  /// and writes case.prm and run.json. To be constructed once the input is known to be valid.
  /// @throws InputError if another process writes to the directory, or case.prm would replace the user's own case:
  /// nothing is written then @throws OutputError
  Run(const input::Options &options, const input::Parameters &parameters);

  /// Creates the directory of a run without a case: run.json alone.
  explicit Run(const input::Options &options) : Run(options, nullptr) {}

  /// Reports the checkpoint from which the run continues, in words and in run.json.
  void record_checkpoint(const output::Checkpoints &checkpoints);

  const std::string &directory() const { return directory_; }
  output::RunInfo &info() { return record_->info; }
  bool is_root() const { return is_root_; } ///< true on rank 0
  /// Returns whether to print: on rank 0, unless --quiet.
  bool is_verbose() const { return is_verbose_; }
  bool has_default_threads() const { return has_default_threads_; } ///< see commands::has_default_threads()

  /// Writes results.json, results.csv and the final run.json, and prints the rows. Of many rows it prints the number of
  /// each claim and those that fail, unless --verbose.
  support::ExitCode finish(const output::Results &results);

  /// Does the same for a run that was stopped by a signal.
  support::ExitCode interrupted(const output::Results &results);

  /// Writes results.json, results.csv and the final run.json, prints nothing. @return `exit_code`
  support::ExitCode end(const output::Results &results, support::ExitCode exit_code);

private:
  Run(const input::Options &options, const input::Parameters *parameters);
  // Moves the files of an earlier run aside, unless this run resumes.
  void clear(const input::Options &options, bool has_case) const;
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

/// Exit code of a program whose results alone decide.
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
