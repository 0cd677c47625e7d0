#include "lattice/row_kernels.h"

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "lattice/forces.h"
#include "tests/lattice/sheets.h"

namespace row_kernels_test
{

using namespace latcon;

using namespace lattice;

// Sets the environment variable for processes that start while this lives.
struct Environment
{
  explicit Environment(const std::string &best)
  {
    if (const char *const value = std::getenv(name))
      before = value;
    setenv(name, best.c_str(), 1);
  }
  ~Environment() { before ? setenv(name, before->c_str(), 1) : unsetenv(name); }
  Environment(const Environment &) = delete;
  Environment &operator=(const Environment &) = delete;

  static constexpr const char *name = "LATCON_INSTRUCTION_SET";
  std::optional<std::string> before;
};

// Ends the process, with 2 if forces refuse the environment.
void use_kernels()
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  try
  {
    Forces forces(sheet, material);
    const State state = homogeneous_state(sheet, material, sheets::stretched(1.2, 1.3), Edges::held);
    forces.evaluate(state, state.vx, state.vy);
    std::fprintf(stderr, "uses %s, best of %zu\n", kernels::instruction_set().c_str(),
                 kernels::instruction_sets().size());
    std::exit(0);
  }
  catch (const std::invalid_argument &error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    std::exit(2);
  }
}

// In processes that start anew, since the variable is read once.
TEST(InstructionSets, AreLimitedByTheEnvironment)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string last = kernels::instruction_sets().back(); // the same in those processes
  const Environment environment(last);
  EXPECT_EXIT(use_kernels(), testing::ExitedWithCode(0), "uses " + last + ", best of 1\n");
}

TEST(InstructionSets, RefuseAnEnvironmentThatNamesNone)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const std::string name : {"MMX", ""})
  {
    const Environment environment(name);
    EXPECT_EXIT(use_kernels(), testing::ExitedWithCode(2),
                "variable LATCON_INSTRUCTION_SET: `" + name +
                  "` is none of the instruction sets on this machine: [A-Z]");
  }
}

} // namespace row_kernels_test
