// Estimates of what a run takes: sizes are those of the sheets. Memory and time: dry_run_test.py.
#include "verification/resources/resources.h"

#include <gtest/gtest.h>

#include "support/errors.h"
#include "tests/support/thrown.h"

namespace resources_test
{

using namespace latcon;
using namespace input;
using namespace resources;

Case square()
{
  Case input;
  input.spacing = 1e-3;
  input.length = input.height = 0.02;
  input.density = 1000.;
  return input;
}

TEST(Resources, UnknownsOfARectangleAreThoseOfItsNodes)
{
  Case input = square();
  input.continuum.cells_x = input.continuum.cells_y = 24;
  input.continuum.degree = 3;
  const ContinuumSize size = continuum_size(input);
  EXPECT_EQ(size.cells, 576.);
  EXPECT_EQ(size.unknowns, 2. * 73. * 73.);
  EXPECT_EQ(size.final_unknowns, size.unknowns);
  EXPECT_EQ(size.coarse_unknowns, size.unknowns); // few enough to be solved directly
  input.continuum.direct_limit = 0;
  EXPECT_EQ(continuum_size(input).coarse_unknowns, 2. * 19. * 19.); // 6 x 6 cells: with 12 x 12 there are 2738
}

TEST(Resources, FactorsOfTheCoarsestMeshFillUpBeyondTwentyThousandUnknowns)
{
  const auto bytes = [](double coarse)
  {
    ContinuumSize size{};
    size.coarse_unknowns = coarse;
    return continuum_memory(square(), size).shared;
  };
  EXPECT_DOUBLE_EQ(bytes(2e4), 2. * bytes(1e4));
  EXPECT_DOUBLE_EQ(bytes(8e4), 4. * 1.3 * bytes(2e4));
}

TEST(Resources, AdaptiveCyclesAddThreeCellsForEachThatIsRefined)
{
  Case input = square();
  input.continuum.adaptive_cycles = 2;
  input.continuum.refined_fraction = 1.;
  const ContinuumSize size = continuum_size(input);
  EXPECT_NEAR(size.final_unknowns / size.unknowns, 16., 1.5);
}

TEST(Resources, MoreUnknownsThanHaveNumbersAreRefused)
{
  Case input = square();
  input.continuum.cells_x = input.continuum.cells_y = 65536;
  EXPECT_THROW((void)continuum_size(input), latcon::support::InputError);
  input.continuum.cells_x = input.continuum.cells_y = 2;
  input.continuum.adaptive_cycles = 30;
  input.continuum.refined_fraction = 1.;
  EXPECT_THROW((void)continuum_size(input), latcon::support::InputError);
}

TEST(Resources, StepsThatCannotBeCountedAreTold)
{
  Case input = square();
  Parameters parameters;
  input.declare(parameters);
  input.end_time = 1.;
  check_steps(input, 1e-15, parameters);
  check_steps(input, 1e-17, parameters);
  const std::string text = message_of<latcon::support::InputError>([&] { parameters.finish(); });
  EXPECT_EQ(text.find("Time/end"), text.rfind("Time/end")) << text; // of the second alone
  EXPECT_NE(text.find("1e+17 time steps"), std::string::npos) << text;
}

} // namespace resources_test
