#include "continuum/parallel_session.h"
#include "verification/commands/command_line.h"
#include "verification/commands/signals.h"

int main(int argc, char **argv)
{
  latcon::commands::occupy_closed_streams();
  latcon::commands::install_signal_handlers();
  const latcon::continuum::ParallelSession session;
  return static_cast<int>(latcon::commands::run_program(argc, argv));
}
