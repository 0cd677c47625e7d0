// One main for every continuum test program: MPI and the thread limit have to be set before the first test.
#include <gtest/gtest.h>

#include "continuum/parallel_session.h"

using namespace latcon;

// For AddressSanitizer: MPI and Trilinos keep memory until the process ends, some of it in modules that are unloaded by
// then and cannot be named in suppressions. All other checks remain enabled.
extern "C" const char *__asan_default_options();
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const continuum::ParallelSession session;
  return RUN_ALL_TESTS();
}
