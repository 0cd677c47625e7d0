#include <gtest/gtest.h>
#include <mpi.h>

// Sites are shared over ranks, of which there is one here.
int main(int argc, char **argv)
{
  MPI_Init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  const int status = RUN_ALL_TESTS();
  MPI_Finalize();
  return status;
}
