#include "verification/commands/command_line.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <system_error>
#include <thread>

#include <mpi.h>
#include <poll.h>
#include <unistd.h>

#include "continuum/errors.h"
#include "continuum/solver_report.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/signals.h"

namespace latcon::commands
{
namespace
{

struct Failure
{
  support::ExitCode exit_code;
  std::string message;
};

// Exit code and message of an exception. The libraries throw their own types; here they get their exit codes.
Failure describe(const std::exception &error)
{
  if (const auto *known = dynamic_cast<const support::Error *>(&error))
    return {known->exit_code(), error.what()};
  if (dynamic_cast<const continuum::InvalidInput *>(&error) != nullptr ||
      dynamic_cast<const continuum::NonPhysicalState *>(&error) != nullptr)
    return {support::ExitCode::bad_input, error.what()};
  if (dynamic_cast<const continuum::NoSolution *>(&error) != nullptr)
    return {support::ExitCode::solver_failed, error.what()};
  if (dynamic_cast<const continuum::OutputFailed *>(&error) != nullptr ||
      dynamic_cast<const std::filesystem::filesystem_error *>(&error) != nullptr)
    return {support::ExitCode::output_failed, error.what()};
  if (dynamic_cast<const std::bad_alloc *>(&error) != nullptr)
    return {support::ExitCode::bad_input, "out of memory: the run takes more than this machine gives; see --dry-run"};
  if (const auto *system = dynamic_cast<const std::system_error *>(&error);
      system != nullptr && system->code() == std::errc::resource_unavailable_try_again)
    return {support::ExitCode::bad_input,
            "no further thread can be started: raise the limit of processes (ulimit -u, container)"};
  return {support::ExitCode::internal_error, std::string("internal error: ") + error.what()};
}

// Throws if standard output could not be written. A reader that closed its end of a pipe is not an error.
void require_printed()
{
  if (std::cout.flush() && std::fflush(stdout) == 0)
    return;
  pollfd output{STDOUT_FILENO, 0, 0};
  if (poll(&output, 1, 0) != 1 || (output.revents & POLLERR) == 0)
    throw support::OutputError("standard output", "it is closed or full");
}

} // namespace

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
    const unsigned int rank = support::rank();
    const unsigned int n_ranks = support::n_ranks();
    try
    {
      record_exit_code(failure.exit_code, "latcon: " + failure.message + "\n");
    }
    catch (const std::exception &)
    {
      // Most likely a full disk, which is then the failure itself.
    }
    // Most errors occur on all ranks: the root rank reports them, and Open MPI kills the others within two seconds,
    // before they report too. An error on another rank alone is reported after the wait.
    if (rank != 0)
      std::this_thread::sleep_for(std::chrono::seconds(3));
    std::cerr << "latcon: " << (n_ranks > 1 ? "rank " + std::to_string(rank) + ": " : "") << failure.message
              << std::endl;
    // Ranks that wait for this one in a collective call would wait forever.
    if (n_ranks > 1)
      MPI_Abort(MPI_COMM_WORLD, static_cast<int>(failure.exit_code));
    return failure.exit_code;
  }
}

} // namespace latcon::commands
