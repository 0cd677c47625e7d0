#pragma once

#include <functional>

#include "support/errors.h"

namespace latcon::commands
{

/// The program `latcon`: reads the command line, runs the command on every MPI rank, and reports what went wrong.
/// MPI must be initialised. @return the status to exit with
support::ExitCode run_program(int argc, char **argv);

/// Runs a command and returns its exit code, or that of the exception that it throws, whose message goes to standard
/// error; `run.json` and `log.txt` record both. With several ranks an exception ends all of them.
support::ExitCode run_command(const std::function<support::ExitCode()> &command);

} // namespace latcon::commands
