// Estimates of what a run takes: sizes are those of the sheets, and no size is too large for an estimate.
#include "verification/resources/resources.h"

#include <cmath>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace resources_test
{

using namespace latcon;
using namespace input;
using namespace resources;

Case square(double length, double spacing)
{
  Case input;
  input.spacing = spacing;
  input.length = input.height = length;
  input.density = 1000.;
  return input;
}

TEST(Resources, MemoryOfALatticeGrowsAsItsSites)
{
  const auto total = [](double length)
  {
    const MemoryNeed need = lattice_memory(square(length, 1e-3), RunKind::dynamics);
    return need.shared + need.first_rank;
  };
  EXPECT_NEAR(total(1.) / total(0.5), 4., 0.1);
  EXPECT_GT(total(1.), 1.1547e6 * 500.); // 1.1547 sites to a square spacing
  EXPECT_LT(total(1.), 1.1547e6 * 2000.);
}

TEST(Resources, TheLargestSheetHasAnEstimate)
{
  const auto total = [](double length)
  {
    const MemoryNeed need = lattice_memory(square(length, 1e-3), RunKind::fracture, true);
    return need.shared + need.first_rank;
  };
  EXPECT_NEAR(total(1e3) / total(10.), 1e4, 100.); // edges of the smaller sheet, 4 rows of 10^4
}

TEST(Resources, UnknownsOfARectangleAreThoseOfItsNodes)
{
  Case input = square(0.02, 1e-3);
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

TEST(Resources, AdaptiveCyclesAddThreeCellsForEachThatIsRefined)
{
  Case input = square(0.02, 1e-3);
  input.continuum.adaptive_cycles = 2;
  input.continuum.refined_fraction = 1.;
  const ContinuumSize size = continuum_size(input);
  EXPECT_NEAR(size.final_unknowns / size.unknowns, 16., 1.5);
}

TEST(Resources, MoreUnknownsThanHaveNumbersAreRefused)
{
  Case input = square(0.02, 1e-3);
  input.continuum.cells_x = input.continuum.cells_y = 65536;
  EXPECT_THROW((void)continuum_size(input), latcon::support::InputError);
  input.continuum.cells_x = input.continuum.cells_y = 2;
  input.continuum.adaptive_cycles = 30;
  input.continuum.refined_fraction = 1.;
  EXPECT_THROW((void)continuum_size(input), latcon::support::InputError);
}

TEST(Resources, StepsThatCannotBeCountedAreTold)
{
  Case input = square(0.02, 1e-3);
  Parameters parameters;
  input.declare(parameters);
  input.end_time = 1.;
  check_steps(input, 1e-15, parameters);
  check_steps(input, 1e-17, parameters);
  try
  {
    parameters.finish();
    FAIL() << "no exception";
  }
  catch (const latcon::support::InputError &error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.find("Time/end"), text.rfind("Time/end")) << text; // of the second alone
    EXPECT_NE(text.find("1e+17 time steps"), std::string::npos) << text;
  }
}

} // namespace resources_test
