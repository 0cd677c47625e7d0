#include <gtest/gtest.h>

#include "continuum/parallel_session.h"

using namespace latcon;

// Sites are distributed over ranks; there is one rank here.
int main(int argc, char **argv)
{
  const continuum::ParallelSession session;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
