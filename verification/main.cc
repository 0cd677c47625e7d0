#include "continuum/parallel_session.h"
#include "verification/commands/command_line.h"

int main(int argc, char **argv)
{
  const continuum::ParallelSession session;
  return static_cast<int>(verification::run_program(argc, argv));
}
