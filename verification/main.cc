#include "continuum/parallel_session.h"
#include "verification/commands/command_line.h"
#include "verification/commands/signals.h"

int main(int argc, char **argv)
{
  latcon::verification::install_signal_handlers();
  const latcon::continuum::ParallelSession session;
  return static_cast<int>(latcon::verification::run_program(argc, argv));
}
