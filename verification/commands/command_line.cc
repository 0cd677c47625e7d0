#include "verification/commands/command_line.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <thread>

#include <dlfcn.h>
#include <omp.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>

#include "continuum/errors.h"
#include "continuum/solver_report.h"
#include "support/atomic_file.h"
#include "support/available_cores.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/signals.h"
#include "verification/input/data_folder.h"
#include "verification/study/study_file.h"

namespace latcon::commands
{
namespace
{

struct Failure
{
  support::ExitCode exit_code;
  std::string message;
};

// What an exception means to the user. The libraries throw their own types; this is where they get their exit codes.
Failure describe(const std::exception &error)
{
  if (const auto *known = dynamic_cast<const support::Error *>(&error))
    return {known->exit_code(), error.what()};
  if (dynamic_cast<const continuum::SolverFailed *>(&error) != nullptr ||
      dynamic_cast<const continuum::LinearSolverFailed *>(&error) != nullptr)
    return {support::ExitCode::solver_failed, error.what()};
  if (dynamic_cast<const continuum::InvalidInput *>(&error) != nullptr ||
      dynamic_cast<const continuum::InvalidMaterial *>(&error) != nullptr ||
      dynamic_cast<const continuum::NonPhysicalState *>(&error) != nullptr)
    return {support::ExitCode::bad_input, error.what()};
  if (dynamic_cast<const continuum::OutputFailed *>(&error) != nullptr ||
      dynamic_cast<const std::filesystem::filesystem_error *>(&error) != nullptr)
    return {support::ExitCode::output_failed, error.what()};
  if (dynamic_cast<const std::bad_alloc *>(&error) != nullptr)
    return {support::ExitCode::bad_input, "out of memory: the run takes more than this machine gives; see --dry-run"};
  return {support::ExitCode::internal_error, std::string("internal error: ") + error.what()};
}

// As many threads on each rank as said, or as there are cores for it.
void set_threads(unsigned int threads)
{
  const unsigned int wanted = threads > 0 ? threads : support::available_cores_per_rank();
  omp_set_num_threads(static_cast<int>(wanted));
  dealii::MultithreadInfo::set_thread_limit(1);
  // A threaded BLAS sums in an order that depends on the number of threads. OpenBLAS is asked if it is the one in use.
  if (void *const symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))
    reinterpret_cast<void (*)(int)>(symbol)(1);
}

// Throws if what was printed could not be written. A reader that closed its end of a pipe has what it wanted.
void require_printed()
{
  if (std::cout.flush() && std::fflush(stdout) == 0)
    return;
  pollfd output{STDOUT_FILENO, 0, 0};
  if (poll(&output, 1, 0) != 1 || (output.revents & POLLERR) == 0)
    throw support::OutputError("standard output", "it is closed or full");
}

// Runs a command, and sees to it that the exit code is the same wherever it is read.
support::ExitCode run_command(const std::function<support::ExitCode()> &command)
{
  try
  {
    const support::ExitCode exit_code = command();
    if (exit_code == support::ExitCode::done)
      require_printed();
    disregard_signals();
    record_exit_code(exit_code);
    return exit_code;
  }
  catch (const std::exception &error)
  {
    disregard_signals();
    const Failure failure = describe(error);
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    try
    {
      record_exit_code(failure.exit_code);
    }
    catch (const std::exception &)
    {
      // A disk that is full is most likely the failure itself.
    }
    // Most errors are met by all ranks alike: the first one reports them. One met by another rank alone is reported a
    // moment later.
    if (rank != 0)
      std::this_thread::sleep_for(std::chrono::seconds(1));
    std::cerr << "latcon: " << (n_ranks > 1 ? "rank " + std::to_string(rank) + ": " : "") << failure.message
              << std::endl;
    // Ranks that wait for this one in a collective call would wait for ever.
    if (n_ranks > 1)
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(failure.exit_code));
    return failure.exit_code;
  }
}

} // namespace

support::ExitCode run_program(int argc, char **argv)
{
  input::Options options;
  options.arguments.assign(argv, argv + argc);
  std::function<support::ExitCode()> command;

  CLI::App app("latcon: dynamic fracture of rubber on a triangular lattice, and the continuum beside it", "latcon");
  app.set_version_flag("--version", "latcon " + output::program_version() + " (" + output::git_commit() + ")");
  app.require_subcommand(1);
  app.fallthrough();
  app.footer("Exit codes: 0 done, every claim holds; 1 internal error; 2 bad input; 3 a claim does not hold;\n"
             "4 a solver did not converge or the state blew up; 5 a file could not be written; 130 interrupted.");
  app.add_option("--set", options.overrides, "Section/Name=value, replaces an entry of the case; repeatable")
    ->allow_extra_args(false)
    ->type_name("ENTRY");
  app.add_option("--output-dir", options.output_dir, "where to write")->capture_default_str()->type_name("DIR");
  app.add_option("--threads", options.threads, "threads of the lattice on each rank; default: all cores")
    ->check(CLI::Range(1u, 4096u))
    ->type_name("N");
  app.add_flag("--quiet", options.quiet, "print errors only");
  app.add_flag("--verbose", options.verbose, "of a crack, print every row that was checked, not only those that fail");
  app.add_flag("--resume", options.resume,
               "go on from the last checkpoint, or keep the runs of a study that are there");
  app.add_flag("--dry-run", options.dry_run, "check the input, print the resolved case and its cost, run nothing");

  options.case_file = input::data_folder() + "/cases/fig1.prm";
  CLI::App *verify_command = app.add_subcommand("verify", "check that lattice and continuum agree, claim by claim");
  verify_command->add_option("CLAIM", options.claims, "claims to check; default: all but those marked (only if named)")
    ->check(CLI::Validator([](const std::string &name) { return unknown_claim(name); }, claim_choices()))
    ->type_name("");
  verify_command
    ->add_option("--case", options.case_file,
                 "case whose material, loading and laws to verify; default: every law on the rubber of Fig. 1")
    ->type_name("FILE");
  verify_command->add_flag("--quick", options.quick, "small versions");
  verify_command->footer(claim_list() + verify_command->get_footer());
  verify_command->callback(
    [&]
    {
      options.case_is_given = verify_command->count("--case") > 0 || !options.overrides.empty();
      command = [&] { return verify(options); };
    });

  const auto add_case_command =
    [&](const std::string &name, const std::string &help, support::ExitCode (*run)(const input::Options &))
  {
    CLI::App *subcommand = app.add_subcommand(name, help);
    subcommand->add_option("CASE", options.case_file, "case file, .prm or .json")->required()->type_name("");
    subcommand->callback([&command, &options, run] { command = [&options, run] { return run(options); }; });
    return subcommand;
  };
  add_case_command("lattice", "equilibrium or motion of the unbroken lattice sheet", run_lattice);
  add_case_command("continuum", "equilibrium or motion of the finite element sheet", run_continuum);
  add_case_command("fracture", "verify the case's material and pre-stretch, then run its crack", run_fracture)
    ->add_flag("--skip-verification", options.skip_verification, "run the crack unverified; noted in every output");
  app.get_subcommand("fracture")->add_flag("--no-report", options.no_report, "draw neither pictures nor page");

  std::string study;
  CLI::App *study_command = app.add_subcommand("study", "a sweep of cracks, set beside what a source states");
  study_command->add_option("STUDY", study, study::study_choices())->required()->type_name("");
  study_command->add_flag("--quick", options.quick, "small version");
  study_command->add_flag("--skip-verification", options.skip_verification,
                          "run the cracks unverified; noted in every output");
  study_command->callback([&] { command = [&] { return run_study(options, study); }; });

  CompareOptions chosen;
  CLI::App *compare_command = app.add_subcommand("compare", "a lattice frame beside a continuum frame, site by site");
  compare_command->add_option("LATTICE", chosen.lattice, "frame (.vtp), series (.pvd) or output directory of a lattice")
    ->required()
    ->type_name("");
  compare_command
    ->add_option("CONTINUUM", chosen.continuum, "frame (.vtu, .pvtu), series (.pvd) or output directory of a continuum")
    ->required()
    ->type_name("");
  const auto add_time = [&](const std::string &name, std::string &time, const std::string &help)
  { compare_command->add_option(name, time, help)->type_name("TIME"); };
  add_time("--time", chosen.time, "time of both frames, or load factor; default: the last");
  add_time("--lattice-time", chosen.lattice_time, "time of the lattice frame");
  add_time("--continuum-time", chosen.continuum_time, "time of the continuum frame; with --lattice-time it may differ");
  compare_command
    ->add_option("--tolerance", chosen.tolerances,
                 "FIELD=VALUE, largest relative root-mean-square difference that holds; repeatable")
    ->allow_extra_args(false)
    ->type_name("FIELD=VALUE");
  compare_command->add_flag("--overlap", chosen.overlap,
                            "compare where both sheets are; one may be a part of the other, as beside a crack");
  compare_command
    ->add_option("--exclude", chosen.excluded,
                 "X,Y,R, centre and radius of a circle in the undeformed sheet whose sites are not compared, as at a "
                 "crack tip; repeatable")
    ->allow_extra_args(false)
    ->type_name("X,Y,R");
  compare_command->callback([&] { command = [&] { return compare_frames(options, chosen); }; });

  std::string report_directory;
  CLI::App *report_command = app.add_subcommand("report", "summary table, pictures and report.html of a finished run");
  report_command->add_option("DIR", report_directory, "output directory of a run, or a folder of several")
    ->required()
    ->type_name("");
  report_command->callback([&] { command = [&] { return report(options, report_directory); }; });

  CLI::App *schema_command = app.add_subcommand("schema", "all entries of a case as JSON, with the values of one");
  schema_command->add_option("CASE", options.case_file, "case whose values to print; default: declarations only")
    ->type_name("");
  schema_command->callback(
    [&]
    {
      options.case_is_given = schema_command->count("CASE") > 0;
      command = [&] { return print_schema(options); };
    });

  return run_command(
    [&]
    {
      try
      {
        app.parse(argc, argv);
      }
      catch (const CLI::ParseError &error)
      {
        // Help and version are exceptions of CLI11 as well, with exit code 0.
        if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          app.exit(error);
        return error.get_exit_code() == 0 ? support::ExitCode::done : support::ExitCode::bad_input;
      }
      set_threads(options.threads);
      return command();
    });
}

} // namespace latcon::commands
