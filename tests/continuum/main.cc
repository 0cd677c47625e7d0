// One main for every continuum test program: MPI and the thread limit have to be set before the first test.
#include <gtest/gtest.h>

#include <string>

#include "continuum/parallel_session.h"
#include "support/ranks.h"

using namespace latcon;

// For AddressSanitizer: MPI and Trilinos keep memory until the process ends, some of it in modules that are unloaded by
// then and cannot be named in suppressions. All other checks remain enabled.
extern "C" const char *__asan_default_options();
extern "C" const char *__asan_default_options()
{
  return "detect_leaks=0";
}

namespace
{
// Returns which tests run: on one rank all but the suites that need several, on several ranks only those and the suites
// that are for any number of ranks.
std::string filter(const std::string &given)
{
  if (support::n_ranks() == 1)
    return given + (given.find('-') == std::string::npos ? "-" : ":") + "*Ranks.*";
  const bool has_names = !given.empty() && given != "*" && given.front() != '-';
  return (has_names ? "" : "*Ranks.*:Assembly.*:*ForcesOfRates.*:MotionArchive.*") + (given == "*" ? "" : given);
}
} // namespace

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const continuum::ParallelSession session;
  GTEST_FLAG_SET(filter, filter(GTEST_FLAG_GET(filter)));
  return RUN_ALL_TESTS();
}
