#include <cstdlib>

#include <deal.II/base/mpi.h>

#include "verification/commands/command_line.h"

int main(int argc, char **argv)
{
  // Without mpirun, Open MPI would start a daemon of its own beside the program, for processes that are never spawned.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return static_cast<int>(verification::run_program(argc, argv));
}
