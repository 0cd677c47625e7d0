#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <numeric>
#include <system_error>

#include "support/available_cores.h"
#include "support/folder_lock.h"
#include "support/machine_memory.h"
#include "support/ranks.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/cost.h"
#include "verification/commands/requested_study.h"
#include "verification/commands/signals.h"
#include "verification/output/output_file.h"
#include "verification/output/progress.h"
#include "verification/resources/resources.h"
#include "verification/study/process_pool.h"
#include "verification/study/refinement.h"
#include "verification/study/shard.h"
#include "verification/study/study_output.h"

namespace latcon::commands
{
namespace
{

namespace fs = std::filesystem;

// The runs of a killed study get SIGTERM, and write a checkpoint before they end.
constexpr std::chrono::seconds patience_with_orphans(10);

// Each shard holds the lock of the study for the time that writing its plan takes.
constexpr std::chrono::seconds patience_with_shards(60);

// Directory of a run, and the directory that replaces it once the run has ended.
struct Folders
{
  std::string whole, part;
};

Folders folders_of(const std::string &directory, const study::PlannedRun &planned)
{
  const std::string whole = directory + "/runs/" + planned.folder();
  return {whole, whole + ".part"};
}

void replace(const Folders &folders)
{
  fs::remove_all(folders.whole);
  fs::rename(folders.part, folders.whole);
}

// The resolved case of a run, which the study wrote before its first run started.
std::string case_file_of(const std::string &directory, const study::PlannedRun &planned)
{
  return directory + "/cases/" + planned.folder() + ".prm";
}

std::vector<std::string> command_of(const study::PlannedRun &planned, const std::string &directory,
                                    const std::string &folder, bool skip_verification, bool resume, bool is_confirmed)
{
  // This program, even if its file has been replaced since it was started.
  std::vector<std::string> command{"/proc/self/exe", "fracture",     case_file_of(directory, planned),
                                   "--side",         planned.side(), "--output-dir",
                                   folder,           "--threads",    "1",
                                   "--no-report"};
  if (skip_verification)
    command.emplace_back("--skip-verification");
  if (resume)
    command.emplace_back("--resume");
  if (is_confirmed)
    command.emplace_back("--yes");
  return command;
}

std::string result_line(const study::RunOutcome &outcome)
{
  if (outcome.state != study::RunState::measured)
    return to_string(outcome.state) + ": " + outcome.problem;
  return outcome.pattern;
}

// Progress of the pool, weighted by the cost of the runs.
class PoolProgress
{
public:
  PoolProgress(const std::vector<study::PlannedRun> &plan, const std::vector<std::size_t> &jobs, bool wanted)
    : plan_(plan), jobs_(jobs), line_(wanted), is_verbose_(wanted), start_(std::chrono::steady_clock::now())
  {
    for (const std::size_t run : jobs)
      total_ += plan[run].seconds;
  }

  void ended(std::size_t run, const study::RunOutcome &outcome)
  {
    ++n_ended_;
    done_ += plan_[run].seconds;
    if (is_verbose_)
      std::cout << "[" << n_ended_ << "/" << jobs_.size() << "] " << plan_[run].folder() << ": " << result_line(outcome)
                << ", " << std::lround(outcome.wall_time) << " s" << std::endl;
  }

  void show(const std::vector<std::size_t> &running)
  {
    if (!line_.due())
      return;
    std::string names;
    for (const std::size_t job : running)
      names += (names.empty() ? "" : ", ") + plan_[jobs_[job]].folder();
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    line_.show(std::to_string(n_ended_) + "/" + std::to_string(jobs_.size()) + " runs, now " + names + ", " +
                 std::to_string(std::lround(elapsed)) + " s so far",
               done_ / total_);
  }

private:
  const std::vector<study::PlannedRun> &plan_;
  const std::vector<std::size_t> &jobs_;
  output::Progress line_;
  bool is_verbose_;
  std::chrono::steady_clock::time_point start_;
  std::size_t n_ended_ = 0;
  double done_ = 0., total_ = 0.;
};

// Runs of a study to start, and their directory.
struct Selection
{
  std::string directory;         // output directory of the study
  std::vector<std::size_t> runs; // indices in the plan, in the order of their start
  bool resume;                   // keep measured runs, continue runs with a checkpoint
  bool is_confirmed;             // run also what costs too much (--yes)
};

// Runs the selected runs that are not measured yet. @return whether all of them ended
bool run_children(study::StudyResults &results, const Selection &selection, bool skip_verification, std::size_t n_cores,
                  Run &run)
{
  const auto phase = run.info().stopwatch().phase("runs");
  const std::string &directory = selection.directory;
  std::vector<std::size_t> jobs;
  for (const std::size_t i : selection.runs)
  {
    const study::PlannedRun &planned = results.plan[i];
    const std::string folder = folders_of(directory, planned).whole;
    if (selection.resume && study::is_finished(planned, folder, skip_verification))
      results.outcomes[i] = study::read_outcome(planned, folder);
    else
      jobs.push_back(i);
  }
  if (run.is_verbose())
    std::cout << jobs.size() << " runs, " << selection.runs.size() - jobs.size() << " are finished already"
              << std::endl;

  for (const char *folder : {"/cases", "/runs"})
    fs::create_directory(directory + folder);
  for (const std::size_t i : selection.runs)
    output::write_file(case_file_of(directory, results.plan[i]), results.plan[i].case_text());
  PoolProgress progress(results.plan, jobs, run.is_verbose());
  study::ProcessPool pool;
  pool.n_jobs = jobs.size();
  pool.limit = n_cores;
  pool.start = [&](std::size_t job) -> study::ProcessPool::Job
  {
    const study::PlannedRun &planned = results.plan[jobs[job]];
    const auto [whole, folder] = folders_of(directory, planned);
    support::require_in_place(folder);
    // A run that failed, as on a full disk, may have checkpoints.
    if (selection.resume && !fs::exists(folder) && study::is_begun(planned, whole, skip_verification))
      fs::rename(whole, folder);
    if (fs::exists(folder))
      lock_directory(folder, patience_with_orphans); // released at once: the run locks it for itself
    const bool goes_on = selection.resume && study::is_begun(planned, folder, skip_verification);
    if (!goes_on)
      fs::remove_all(folder);
    fs::create_directory(folder);
    return {command_of(planned, directory, folder, skip_verification, goes_on, selection.is_confirmed),
            folder + "/log.txt"};
  };
  pool.ended = [&](std::size_t job, int status)
  {
    const study::PlannedRun &planned = results.plan[jobs[job]];
    const Folders folders = folders_of(directory, planned);
    support::require_in_place(folders.whole);
    replace(folders);
    results.outcomes[jobs[job]] = study::read_outcome(planned, folders.whole, status);
    progress.ended(jobs[job], results.outcomes[jobs[job]]);
  };
  pool.waiting = [&](const std::vector<std::size_t> &running) { progress.show(running); };
  pool.stop = any_rank_interrupted;
  const SignalDeferral deferral;
  return study::run_processes(pool);
}

// Memory of the largest runs that can run concurrently, each in its own process.
resources::MemoryNeed memory_of(const std::vector<study::PlannedRun> &plan, std::size_t n_cores)
{
  std::vector<double> needs;
  for (const study::PlannedRun &run : plan)
    needs.push_back(run.memory + support::resident_memory());
  std::sort(needs.rbegin(), needs.rend());
  needs.resize(std::min(needs.size(), n_cores));
  return {std::accumulate(needs.begin(), needs.end(), 0.), 0.};
}

// Runs the points between neighbours of the sweep that differ, level by level. @return whether all runs ended
bool refine_sweep(study::StudyResults &results, const RequestedStudy &requested, Selection selection,
                  study::Verification verification, bool skip_verification, std::size_t n_cores, Run &run)
{
  for (std::size_t level = 1; level <= results.study.refine; ++level)
  {
    study::Study added = results.study;
    added.claims.clear();
    added.runs = study::refined_runs(results.study, results.plan, results.outcomes, level);
    const std::vector<study::PlannedRun> plan =
      study::plan_runs(added, requested.base, requested.settings, verification);
    selection.runs.clear();
    for (const study::PlannedRun &planned : plan)
    {
      selection.runs.push_back(results.plan.size());
      results.plan.push_back(planned);
      results.outcomes.emplace_back();
      results.outcomes.back().run = planned.run;
      results.outcomes.back().seed = planned.seed;
    }
    results.study.runs.insert(results.study.runs.end(), added.runs.begin(), added.runs.end());
    if (run.is_verbose())
      std::cout << "refinement " << level << ": " << added.runs.size() << " cases between neighbours that differ"
                << std::endl;
    if (!run_children(results, selection, skip_verification, n_cores, run))
      return false;
  }
  return true;
}

support::ExitCode exit_code_of(const study::StudyResults &results, const output::Results &rows)
{
  const auto any = [&](study::RunState state)
  {
    return std::any_of(results.outcomes.begin(), results.outcomes.end(),
                       [state](const study::RunOutcome &outcome) { return outcome.state == state; });
  };
  if (any(study::RunState::failed))
    return support::ExitCode::solver_failed;
  return any(study::RunState::refused) || any(study::RunState::rejected) || rows.verdict() == output::Verdict::fails
           ? support::ExitCode::claim_failed
           : support::ExitCode::done;
}

// Checks that a plan is the recorded one of the study whose shards run in a directory.
// @throws InputError if the directory belongs to another study
void require_plan(const std::string &directory, const std::string &plan)
{
  const fs::path file = fs::path(directory) / study::plan_file_name;
  std::ifstream stream(file, std::ios::binary);
  const std::string stored(std::istreambuf_iterator<char>(stream), {});
  if (!stream)
    throw support::InputError(file.string() + " cannot be read: no shard of this study was run in " + directory);
  if (const std::string difference = study::plan_difference(stored, plan); !difference.empty())
    throw support::InputError(directory + " belongs to the runs of another plan: " + difference +
                              "; choose another folder (--output-dir)");
}

// Records the plan of a study that runs in shards in its output directory, and its sweep, unless they are recorded.
// @throws InputError if the directory belongs to another study
void share_plan(const std::string &directory, const std::string &plan, const RequestedStudy &requested)
{
  const fs::path file = fs::path(directory) / study::plan_file_name;
  fs::create_directories(directory);
  // Shards start at the same moment, and each removes unfinished files once it has the lock.
  const auto lock = lock_directory(directory, patience_with_shards);
  if (!fs::exists(file))
    output::write_file(file.string(), plan);
  require_plan(directory, plan);
  write_sweep(requested);
}

// Reads the outcomes of all runs. @throws InputError if some have not ended
void collect_outcomes(study::StudyResults &results, const std::string &directory, bool skip_verification)
{
  constexpr std::size_t max_named = 8;
  std::string missing;
  std::size_t n_missing = 0;
  for (std::size_t i = 0; i < results.plan.size(); ++i)
  {
    const study::PlannedRun &planned = results.plan[i];
    const std::string folder = folders_of(directory, planned).whole;
    // A run that ended before it wrote its record has failed.
    if (study::is_begun(planned, folder, skip_verification) ||
        (fs::exists(folder) && !fs::exists(folder + "/run.json")))
      results.outcomes[i] = study::read_outcome(planned, folder);
    else if (++n_missing <= max_named)
      missing += (missing.empty() ? "" : ", ") + planned.folder();
  }
  if (n_missing > 0)
    throw support::InputError("--collect: " + std::to_string(n_missing) + " of " + std::to_string(results.plan.size()) +
                              " runs have not been run to their end by this program: " + missing +
                              (n_missing > max_named ? ", ..." : "") + "; run their shards again");
}

// Judges the runs, writes the tables and the page, and ends the run.
support::ExitCode judge_runs(const input::Options &options, study::StudyResults &results, bool complete, Run &run)
{
  results.claims = study::judge(results.study, results.plan, results.outcomes);
  output::write_file(run.directory() + "/study.json", study::study_json(results));
  output::write_file(run.directory() + "/study.csv", study::study_csv(results));
  const output::Results rows = study::study_rows(results);
  if (run.is_verbose())
    study::print_table(std::cout, results);
  const support::ExitCode exit_code =
    run.end(rows, complete ? exit_code_of(results, rows) : support::ExitCode::interrupted);
  // A page of an earlier run may remain.
  if (complete && !options.no_report && draw_page(study_page, run.directory()) && run.is_verbose())
    std::cout << run.directory() << "/study.html" << std::endl;
  return exit_code;
}

} // namespace

support::ExitCode run_study(const input::Options &options, const StudyOptions &chosen)
{
  if (support::n_ranks() > 1)
    throw support::InputError("`latcon study` starts its own processes, one a core; run it without mpirun");
  if (chosen.collect && !chosen.shard.empty())
    throw support::InputError("--collect judges the runs of all shards; give it without --shard");
  const bool in_shards = chosen.collect || !chosen.shard.empty();
  const study::Shard shard = chosen.shard.empty() ? study::Shard() : study::parse_shard(chosen.shard);
  const study::Verification verification = verification_of(options);
  study::StudyResults results;
  const RequestedStudy requested = read_requested_study(options, chosen.study, chosen.sweep);
  results.study = requested.study;
  if (in_shards)
    require_no_refinement(results.study);
  results.plan = study::plan_runs(results.study, requested.base, requested.settings, verification);
  for (const study::PlannedRun &planned : results.plan)
  {
    results.outcomes.emplace_back();
    results.outcomes.back().run = planned.run;
    results.outcomes.back().seed = planned.seed;
  }
  results.quick = options.quick;
  const std::size_t n_cores = options.threads > 0 ? options.threads : support::available_cores();
  const resources::MemoryNeed memory = memory_of(results.plan, n_cores);
  if (options.dry_run)
  {
    if (!options.quiet)
    {
      study::print_plan(std::cout, results.study, results.plan, n_cores);
      std::cout << resources::memory_text(memory);
    }
    require_memory(options, memory);
    return support::ExitCode::done;
  }
  require_memory(options, memory);

  const bool skip_verification = verification != study::Verification::every_run; // of the runs
  results.verification = verification == study::Verification::none ? "none (--skip-verification)"
                         : verification == study::Verification::base_case
                           ? "material and pre-stretch of the base case alone (--quick)"
                           : "material and pre-stretch of every run";
  results.is_verified = !skip_verification;

  const std::string plan =
    study::plan_text(results.study.title, results.plan, options.skip_verification, chosen.collect ? 0 : shard.count);
  Selection selection{options.output_dir, study::runs_of_shard(results.plan, shard), options.resume, options.yes};
  input::Options own = options; // those of the record in run.json
  require_folder_of(results.study, options.output_dir);
  if (!chosen.shard.empty())
  {
    share_plan(options.output_dir, plan, requested);
    // A shard has a record and a lock of its own.
    own.output_dir += "/shards/" + std::to_string(shard.index) + "-of-" + std::to_string(shard.count);
    own.resume = selection.resume = true;
  }
  else if (chosen.collect)
  {
    require_plan(options.output_dir, plan);
    collect_outcomes(results, options.output_dir, skip_verification);
    own.resume = true;
    selection.runs.clear();
  }
  else if (fs::exists(fs::path(options.output_dir) / study::plan_file_name))
    throw support::InputError(options.output_dir +
                              " has the runs of a study in shards; give --collect, or another folder "
                              "(--output-dir)");
  Run run(own);
  if (chosen.shard.empty())
    write_sweep(requested);
  run.info().add("skip_verification", options.skip_verification);
  run.info().add("study", results.study.title);
  if (verification == study::Verification::base_case && !chosen.collect)
  {
    const input::Case base = study::base_case(results.study, requested.base, requested.settings);
    const bool on_continuum = std::any_of(results.study.runs.begin(), results.study.runs.end(),
                                          [](const study::StudyRun &one) { return one.on_continuum; });
    (void)require_verified(
      base, on_continuum ? claims_before_continuum_fracture(base.material()) : claims_before_fracture(base.material()),
      on_continuum ? bridge::laws_of(base) : bridge::laws_of_lattice(), run);
  }
  const bool complete =
    chosen.collect || (run_children(results, selection, skip_verification, n_cores, run) &&
                       refine_sweep(results, requested, selection, verification, skip_verification, n_cores, run));
  if (!chosen.shard.empty())
    return run.end({}, complete ? exit_code_of(results, {}) : support::ExitCode::interrupted);
  return judge_runs(options, results, complete, run);
}

} // namespace latcon::commands
