#include "continuum/parallel_session.h"
#include "verification/commands/command_line.h"
#include "verification/commands/signals.h"

int main(int argc, char **argv)
{
  verification::install_signal_handlers();
  const continuum::ParallelSession session;
  return static_cast<int>(verification::run_program(argc, argv));
}
