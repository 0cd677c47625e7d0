#pragma once

#include "support/errors.h"

namespace latcon::commands
{

/// The program `latcon`: reads the command line, runs the command on every MPI rank, and reports what went wrong.
/// MPI must be initialised. @return the status to exit with
support::ExitCode run_program(int argc, char **argv);

} // namespace latcon::commands
