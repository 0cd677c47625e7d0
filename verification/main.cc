#include "support/errors.h"
#include "support/mpi_session.h"
#include "support/waiting_threads.h"
#include "verification/commands/command_line.h"
#include "verification/commands/signals.h"
#include "verification/elements/elements.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <string_view>

int main(int argc, char **argv)
{
  // Options may come before the command.
  constexpr std::string_view with_threads[] = {"verify", "lattice", "continuum", "fracture", "gate"};
  if (std::find_first_of(argv + 1, argv + argc, std::begin(with_threads), std::end(with_threads)) != argv + argc)
    latcon::support::let_waiting_threads_sleep(argv);
  latcon::commands::occupy_closed_streams();
  try
  {
    latcon::commands::install_signal_handlers();
    const latcon::support::MpiSession mpi;
    const latcon::support::ExitCode exit_code = latcon::commands::run_program(argc, argv);
    latcon::elements::finish();
    return static_cast<int>(exit_code);
  }
  catch (const std::exception &error) // of the start, such as no further thread under `ulimit -u`
  {
    std::fprintf(stderr, "latcon: cannot start: %s\n", error.what());
    return static_cast<int>(latcon::support::ExitCode::internal_error);
  }
}
