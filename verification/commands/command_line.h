#pragma once

#include <functional>
#include <string>
#include <vector>

#include "support/errors.h"

namespace CLI
{
class App;
class ParseError;
} // namespace CLI

namespace latcon::commands
{

/// The program `latcon`: reads the command line, runs the command on every MPI rank, and reports what went wrong.
/// MPI must be initialised. @return the status to exit with
support::ExitCode run_program(int argc, char **argv);

/// Runs a command and returns its exit code, or that of the exception that it throws, whose message goes to standard
/// error; `run.json` and `log.txt` record both. With several ranks an exception ends all of them.
support::ExitCode run_command(const std::function<support::ExitCode()> &command);

/// Names of the listed commands; those that only the Python package starts are not.
[[nodiscard]] std::vector<std::string> command_names(const CLI::App &app);

/// Message for a command line that could not be parsed: the unknown command, option or argument with the nearest known
/// one, otherwise the words of the parser; and which help to read.
[[nodiscard]] std::string usage_error(const CLI::App &app, const CLI::ParseError &error);

} // namespace latcon::commands
