#include <gtest/gtest.h>

#include "continuum/parallel_session.h"

using namespace latcon;

// Sites are shared over ranks, of which there is one here.
int main(int argc, char **argv)
{
  const continuum::ParallelSession session;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
