#include "verification/commands/command.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "support/atomic_file.h"
#include "support/ranks.h"
#include "verification/commands/recorded_output.h"
#include "verification/commands/signals.h"
#include "verification/input/files.h"
#include "verification/output/checkpoints.h"
#include "verification/output/output_file.h"

namespace latcon::commands
{
namespace
{

// Reports libraries of bond laws that are not the same on all ranks: other machines may have others below one path.
// Collective.
void require_same_libraries(const input::Case &input, input::Parameters &parameters)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
  {
    const std::string &own = input.shell(number).user_law.sha256;
    const int differs = own != support::broadcast(own) ? 1 : 0;
    if (support::largest_on_ranks(differs) > 0)
      parameters.error(std::string(input::Case::shell_sections[number]) + "/library",
                       "the ranks find different libraries, or some none",
                       {std::string(input::Case::shell_sections[number]) + "/law"});
  }
}

// Locks an existing directory, and removes the unfinished files that killed runs left in it and in its checkpoints.
// Waits for a moment for another process to end. @throws InputError if it still writes there @throws
// support::OutputError
std::unique_ptr<support::FolderLock> lock_directory(const std::string &directory)
{
  auto lock = std::make_unique<support::FolderLock>(directory, std::chrono::seconds(1));
  if (lock->is_held())
    for (const std::string &folder : {directory, directory + "/checkpoints"})
      support::remove_stale_parts(folder, std::filesystem::file_time_type::max());
  return lock;
}

} // namespace

void read_case(const input::Options &options, input::Case &input, input::Parameters &parameters)
{
  input.declare(parameters);
  parameters.read_file(options.case_file);
  parameters.read_overrides(options.overrides);
  input.nonlocal.is_used = options.on_continuum;
  input.check(parameters);
  require_same_libraries(input, parameters);
}

bool has_default_threads(const input::Options &options)
{
  return options.threads == 0 && std::getenv("OMP_NUM_THREADS") == nullptr;
}

void print_dry_run(const input::Options &options, const std::string &text)
{
  if (support::is_root_rank() && !options.quiet)
    std::cout << text << std::flush;
}

std::shared_ptr<Run::Record> Run::last;

void Run::Record::write(std::optional<support::ExitCode> with) const
{
  info.write(directory + "/run.json", with, verdict);
  write_log();
}

void Run::Record::write_log() const
{
  if (keeps_log)
    output::write_file(directory + "/log.txt", log_header + RecordedOutput::text() + log_end);
}

void record_exit_code(support::ExitCode exit_code, const std::string &message)
{
  const std::shared_ptr<Run::Record> record = std::exchange(Run::last, nullptr);
  if (!record)
    return;
  record->log_end += message;
  if (record->exit_code != exit_code)
    record->write(exit_code);
  else
    record->write_log();
}

Run::Run(const input::Options &options, const input::Parameters *parameters, const output::Checkpoints *checkpoints)
  : record_(std::make_shared<Record>(options)), directory_(options.output_dir), is_root_(support::is_root_rank()),
    is_verbose_(is_root_ && !options.quiet), prints_all_(options.verbose),
    resumes_(checkpoints != nullptr && checkpoints->found()),
    has_default_threads_(commands::has_default_threads(options))
{
  if (parameters != nullptr)
  {
    info().add("case_hash", input::sha256(input::case_lines(*parameters)));
    nlohmann::ordered_json entries;
    for (const auto &[key, value] : parameters->values())
      entries[key] = value;
    info().add("entries", entries);
  }
  if (is_root_)
  {
    const std::filesystem::path own = directory_ + "/case.prm";
    std::error_code none;
    if (parameters != nullptr && std::filesystem::equivalent(own, options.case_file, none) &&
        !output::is_listed_output(own))
      throw support::InputError("the run would overwrite its own case " + options.case_file +
                                "; give another --output-dir, or move the case out of it");
    support::create_folders(directory_);
    record_->lock = lock_directory(directory_);
    clear(options);
    if (parameters != nullptr)
      output::write_file(own.string(), parameters->resolved_text());
    begin_log(options);
    const SignalDeferral deferral; // once run.json exists, it gets the exit code
    record_->write(std::nullopt);
    last = record_;
    on_interruption([record = record_] { record->write(support::ExitCode::interrupted); });
  }
  // No other rank writes before the directory exists.
  MPI_Barrier(MPI_COMM_WORLD);
  if (resumes_)
    record_checkpoint(*checkpoints);
  else if (is_verbose_ && options.resume)
    std::cout << "No checkpoint in " << directory_ << ": starting from the beginning\n";
}

void Run::clear(const input::Options &options) const
{
  std::error_code none;
  if (const std::filesystem::path page = directory_ + "/report.html"; resumes_ && output::is_listed_output(page))
    std::filesystem::remove(page, none); // describes the run before it continues
  if (!resumes_)
  {
    const std::filesystem::path aside = output::archive_earlier_output(directory_, options.case_file);
    if (is_verbose_ && !aside.empty())
      std::cout << "The files of an earlier run in " << directory_ << " are now in " << aside.string() << std::endl;
  }
  output::begin_output_list(directory_);
}

// A resumed run appends to the existing log.
void Run::begin_log(const input::Options &options)
{
  const std::string file = directory_ + "/log.txt";
  std::error_code none;
  // A log.txt that latcon did not write belongs to the user, who may have redirected the output of this program to it.
  record_->keeps_log =
    !std::filesystem::equivalent("/proc/self/fd/1", file, none) &&
    !std::filesystem::equivalent("/proc/self/fd/2", file, none) &&
    (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, none)) || output::is_listed_output(file));
  if (resumes_)
    record_->log_header = input::read_input_file(file).text;
  for (const std::string &argument : options.arguments)
    record_->log_header += (&argument == options.arguments.data() ? "$ " : " ") + argument;
  record_->log_header += "\n";
}

void Run::record_checkpoint(const output::Checkpoints &checkpoints)
{
  const output::CheckpointPlace &found = *checkpoints.found();
  info().add("resumed_from", {{"checkpoint", found.file.filename().string()},
                              {"step", found.step},
                              {"time", found.time},
                              {"git_commit", found.commit},
                              {"program_hash", found.program_hash}});
  if (!is_verbose_)
    return;
  std::cout << "Resuming from " << found.file.string() << ": step " << found.step << ", t = " << found.time << " s\n";
  if (found.program_hash != output::program_hash())
    std::cout << "It was written by another build of latcon, commit " << found.commit << "; run.json names both\n";
}

support::ExitCode Run::end(const output::Results &results, support::ExitCode exit_code)
{
  if (is_root_)
  {
    const SignalDeferral deferral;
    results.write(directory_);
    record_->verdict = to_string(results.verdict());
    nlohmann::ordered_json failed = nlohmann::ordered_json::object();
    for (const auto &[row, kind] : results.failed_rows())
      failed[row] = to_string(kind);
    info().add("failed_rows", failed);
    if (exit_code == support::ExitCode::interrupted)
      record_->log_end = "latcon: interrupted; --resume continues from what is in " + directory_ + "\n";
    record_->write(exit_code);
    record_->exit_code = exit_code;
    std::cerr << record_->log_end << std::flush;
  }
  return exit_code;
}

support::ExitCode exit_code_of(const output::Results &results)
{
  if (interrupted())
    return support::ExitCode::interrupted;
  return results.verdict() == output::Verdict::fails ? support::ExitCode::claim_failed : support::ExitCode::done;
}

void Run::print(const output::Results &results) const
{
  if (!is_verbose_)
    return;
  constexpr std::size_t longest_table = 20, most_failing_rows = 20;
  const bool is_long = results.rows().size() > longest_table && !prints_all_;
  if (is_long)
    std::cout << claim_lines(results) << "all rows: " << directory_ << "/results.csv, or --verbose\n";
  else
    results.print(std::cout);
  // Failures come last, where a reader looks first.
  if (is_long || results.count(output::Verdict::fails) > 0)
    std::cout << "\n" << results.verdict_text(most_failing_rows);
}

support::ExitCode Run::finish(const output::Results &results)
{
  const support::ExitCode exit_code = end(results, exit_code_of(results));
  print(results);
  return exit_code;
}

} // namespace latcon::commands
