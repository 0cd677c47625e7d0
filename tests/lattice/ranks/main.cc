// MPI has to run before the first test.
#include <gtest/gtest.h>

#include "support/mpi_session.h"

// Under AddressSanitizer: MPI keeps memory until the process ends, some of it in modules unloaded by then, which no
// suppression can name. Every other check stays on.
extern "C" const char *__asan_default_options();
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const latcon::support::MpiSession session;
  return RUN_ALL_TESTS();
}
