#include <deal.II/base/mpi.h>

#include "verification/commands/command_line.h"

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return static_cast<int>(verification::run_program(argc, argv));
}
