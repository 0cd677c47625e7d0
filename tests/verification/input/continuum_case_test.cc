// Entries of the finite element sheet: defaults that are accepted, and combinations that are refused with the
// entry to change.
#include "support/errors.h"
#include "verification/input/case.h"

#include <gtest/gtest.h>

#include <cmath>

namespace continuum_case_test
{

using namespace latcon;
using namespace input;

using Lines = std::vector<std::string>;

// A case with the overrides, checked.
Lines problems(const Lines &overrides, const bool has_inner_edge = false)
{
  Case input;
  input.hole_radius = has_inner_edge ? 1e-3 : 0.;
  Parameters parameters;
  input.continuum.declare(parameters);
  parameters.read_text("", "a.prm");
  parameters.read_overrides(overrides);
  input.continuum.check(parameters, input);
  try
  {
    parameters.finish();
  }
  catch (const latcon::support::InputError &error)
  {
    return error.problems();
  }
  return {};
}

// Expects one problem that names the entry.
void expect_refused(const std::string &entry, const Lines &overrides, const bool has_inner_edge = false)
{
  const Lines found = problems(overrides, has_inner_edge);
  ASSERT_EQ(found.size(), 1u) << entry << "\n"
                              << (found.empty() ? "no problem" : latcon::support::InputError(found).what());
  EXPECT_NE(found[0].find(entry), std::string::npos) << found[0];
}

void expect_accepted(const Lines &overrides, const bool has_inner_edge = false)
{
  const Lines found = problems(overrides, has_inner_edge);
  EXPECT_TRUE(found.empty()) << latcon::support::InputError(found).what();
}

TEST(ContinuumCase, TakesItsDefaults)
{
  expect_accepted({});
  expect_accepted({}, true);
}

TEST(ContinuumCase, ReadsEveryEdge)
{
  ContinuumCase input;
  Parameters parameters;
  input.declare(parameters);
  parameters.read_text("subsection Top edge\n  set displacement x = 1e-3 * y\n  set displacement y = free\nend\n"
                       "subsection Inner edge\n  set traction y = 2*pi\nend\n",
                       "a.prm");
  parameters.finish();
  EXPECT_EQ(input.edges[3].displacement.x, "1e-3 * y");
  EXPECT_EQ(input.edges[3].displacement.y, "free");
  EXPECT_EQ(input.edges[2].displacement.x, "loading");
  EXPECT_EQ(input.edges[4].condition, EdgeCase::Condition::free);
  EXPECT_NEAR(input.edges[4].traction.field()(1, 0.1, 0.2), 2. * std::acos(-1.), 1e-15);
}

TEST(ContinuumCase, RefusesExpressionsThatCannotBeRead)
{
  expect_refused("Top edge/displacement x", {"Top edge/displacement x=sin(z)"});
  expect_refused("Left edge/traction y", {"Left edge/condition=free", "Left edge/traction y=2*"});
  expect_refused("Body force/force x", {"Body force/force x=(x"});
  expect_refused("Initial state/velocity y", {"Initial state/velocity y=loading"});
  expect_refused("Body force/force y", {"Body force/force y=0,5 * x"});
  expect_accepted({"Body force/force y=max(x, y) + atan2(y, x)"});
}

TEST(ContinuumCase, PeriodicEdgesComeInPairsOfAWholeSheet)
{
  const Lines both = {"Left edge/condition=periodic", "Right edge/condition=periodic"};
  expect_accepted(both);
  expect_refused("Left edge/condition", {"Left edge/condition=periodic"});
  expect_refused("Bottom edge/condition", {"Top edge/condition=periodic"});
  expect_refused("Left edge/condition", both, true);
  expect_refused("Left edge/condition", {both[0], both[1], "Continuum/mesh file=a.msh"});
}

TEST(ContinuumCase, GradientsAreHeldByGradientLawsAlone)
{
  const std::string law = "Continuum/gradient=isotropic";
  expect_refused("Top edge/normal gradient", {"Top edge/normal gradient=clamped"});
  expect_refused("Right edge/double traction y", {"Right edge/double traction y=1"});
  expect_refused("Continuum/degree", {law, "Continuum/degree=1"});
  expect_refused("Inner edge/normal gradient", {law, "Inner edge/normal gradient=loading"}, true);
  expect_accepted({law, "Top edge/normal gradient=clamped", "Continuum/degree=2", "Left edge/double traction y=1"});
}

TEST(ContinuumCase, EquilibriumNeedsAHeldEdge)
{
  const Lines free = {"Left edge/condition=free", "Right edge/condition=free", "Bottom edge/condition=free",
                      "Top edge/condition=free"};
  expect_refused("Left edge/condition", free);
  Lines moving = free;
  moving.push_back("Continuum/solution=motion");
  expect_accepted(moving);
  Lines inner = free;
  inner.push_back("Inner edge/condition=held");
  expect_accepted(inner, true);
  expect_refused("Left edge/condition", inner); // there is none inside
}

TEST(ContinuumCase, AnEdgeIsHeldOrLoaded)
{
  expect_refused("Top edge/condition", {"Top edge/displacement x=free", "Top edge/displacement y=free"});
  expect_refused("Top edge/traction y", {"Top edge/traction y=1e3"});
  expect_refused("Top edge/traction x", {"Top edge/traction x=1e3", "Top edge/displacement y=free"});
  expect_accepted({"Top edge/traction y=1e3", "Top edge/displacement y=free"});
  expect_refused("Continuum/adaptive cycles", {"Continuum/solution=motion", "Continuum/adaptive cycles=1"});
}

// Such a load would have no effect.
TEST(ContinuumCase, PeriodicAndClampedEdgesTakeNoLoads)
{
  const std::string law = "Continuum/gradient=lattice";
  const Lines both = {law, "Left edge/condition=periodic", "Right edge/condition=periodic"};
  const auto with = [](Lines entries, const std::string &entry)
  {
    entries.push_back(entry);
    return entries;
  };
  expect_refused("Left edge/traction y", with(both, "Left edge/traction y=1"));
  expect_refused("Left edge/normal gradient", with(both, "Left edge/normal gradient=clamped"));
  expect_refused("Right edge/double traction y", with(both, "Right edge/double traction y=1"));
  expect_refused("Top edge/double traction x",
                 {law, "Top edge/double traction x=1", "Top edge/normal gradient=clamped"});
}

} // namespace continuum_case_test
