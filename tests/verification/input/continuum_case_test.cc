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

// Problems of a case with overrides.
Lines problems(const Lines &overrides, bool has_inner_edge)
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
  catch (const support::InputError &error)
  {
    return error.problems();
  }
  return {};
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
  EXPECT_EQ(input.edges[4].traction.field()(0, 0.1, 0.2), 0.);
  const auto loading = input.edges[2].displacement.field((Eigen::Matrix2d() << 2., 3., 5., 7.).finished());
  EXPECT_NEAR(loading(0, 0.1, 0.2), 0.1 + 0.6, 1e-15);
  EXPECT_NEAR(loading(1, 0.1, 0.2), 0.5 + 1.2, 1e-15);
}

// Overrides, and the entry that their one problem names; none: they are accepted.
struct Choice
{
  Lines overrides;
  std::string entry = "";
  bool has_inner_edge = false;
};

const std::string isotropic = "Continuum/gradient=isotropic", lattice_gradient = "Continuum/gradient=lattice",
                  left = "Left edge/condition=periodic", right = "Right edge/condition=periodic";

Lines free_edges(const Lines &others = {})
{
  Lines all{"Left edge/condition=free", "Right edge/condition=free", "Bottom edge/condition=free",
            "Top edge/condition=free"};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

TEST(ContinuumCase, NamesTheEntryThatDoesNotFit)
{
  for (const auto &[overrides, entry, has_inner_edge] : std::vector<Choice>{
         {{}},
         {{}, "", true},
         // Expressions that cannot be read.
         {{"Top edge/displacement x=sin(z)"}, "Top edge/displacement x"},
         {{"Left edge/condition=free", "Left edge/traction y=2*"}, "Left edge/traction y"},
         {{"Body force/force x=(x"}, "Body force/force x"},
         {{"Initial state/velocity y=loading"}, "Initial state/velocity y"},
         {{"Body force/force y=0,5 * x"}, "Body force/force y"},
         {{"Body force/force y=max(x, y) + atan2(y, x)"}},
         // Periodic edges come in pairs of a whole sheet.
         {{left, right}},
         {{left}, "Left edge/condition"},
         {{"Top edge/condition=periodic"}, "Bottom edge/condition"},
         {{left, right}, "Left edge/condition", true},
         {{left, right, "Continuum/mesh file=a.msh"}, "Left edge/condition"},
         // Gradients are held by gradient laws alone.
         {{"Top edge/normal gradient=clamped"}, "Top edge/normal gradient"},
         {{"Right edge/double traction y=1"}, "Right edge/double traction y"},
         {{isotropic, "Continuum/degree=1"}, "Continuum/degree"},
         {{isotropic, "Inner edge/normal gradient=loading"}, "Inner edge/normal gradient", true},
         {{isotropic, "Top edge/normal gradient=clamped", "Continuum/degree=2", "Left edge/double traction y=1"}},
         // Equilibrium needs a held edge.
         {free_edges(), "Left edge/condition"},
         {free_edges({"Continuum/solution=motion"})},
         {free_edges({"Inner edge/condition=held"}), "", true},
         {free_edges({"Inner edge/condition=held"}), "Left edge/condition"},
         // An edge is held or loaded.
         {{"Top edge/displacement x=free", "Top edge/displacement y=free"}, "Top edge/condition"},
         {{"Top edge/traction y=1e3"}, "Top edge/traction y"},
         {{"Top edge/traction x=1e3", "Top edge/displacement y=free"}, "Top edge/traction x"},
         {{"Top edge/traction y=1e3", "Top edge/displacement y=free"}},
         {{"Continuum/solution=motion", "Continuum/adaptive cycles=1"}, "Continuum/adaptive cycles"},
         // Loads without effect, on periodic and clamped edges.
         {{lattice_gradient, left, right, "Left edge/traction y=1"}, "Left edge/traction y"},
         {{lattice_gradient, left, right, "Left edge/normal gradient=clamped"}, "Left edge/normal gradient"},
         {{lattice_gradient, left, right, "Right edge/double traction y=1"}, "Right edge/double traction y"},
         {{lattice_gradient, "Top edge/double traction x=1", "Top edge/normal gradient=clamped"},
          "Top edge/double traction x"}})
  {
    const Lines found = problems(overrides, has_inner_edge);
    SCOPED_TRACE(testing::PrintToString(overrides) + testing::PrintToString(found));
    ASSERT_EQ(found.size(), entry.empty() ? 0u : 1u);
    EXPECT_TRUE(entry.empty() || found[0].find(entry) != std::string::npos);
  }
}

} // namespace continuum_case_test
