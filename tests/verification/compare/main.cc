#include <gtest/gtest.h>

#include "support/mpi_session.h"

// Sites are shared over ranks, of which there is one here.
int main(int argc, char **argv)
{
  const latcon::support::MpiSession session;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
