// The lattice of a case has the same edges, hole and notch as its finite elements; otherwise the case is refused, with
// the entry to change.
#include "verification/bridge/lattice_sheet.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/verification/input/sentences.h"
#include "tests/verification/input/small_case.h"
#include "verification/bridge/affine_displacement.h"

namespace lattice_sheet_test
{

using namespace latcon;
using namespace bridge;
using namespace input;

using small_case::Lines;

const Lines sheet = {"Loading/strain x=0", "Loading/strain y=0.2", "Right edge/condition=free",
                     "Left edge/condition=free"};

std::size_t count(const lattice::SiteFlags &flags, const lattice::TriangularLattice &lattice, double y)
{
  std::size_t n = 0;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    n += lattice.is_site(place) && flags[place] != 0 && std::abs(lattice.reference(place).y()) <= y;
  return n;
}

TEST(LatticeSheet, HasTheEdgesAndTheHoleOfTheCase)
{
  Parameters of_periodic;
  Case periodic;
  small_case::read({"Left edge/condition=periodic", "Right edge/condition=periodic"}, periodic, of_periodic, sheet);
  EXPECT_TRUE(periodic.lattice().periodic().x);
  EXPECT_FALSE(periodic.lattice().periodic().y);

  Parameters parameters;
  Case input;
  small_case::read({"Sheet/hole radius=4 mm"}, input, parameters, sheet);
  const lattice::TriangularLattice lattice = input.lattice();
  const lattice::State state = lattice_state(input, lattice);
  EXPECT_GT(count(state.held, lattice, 100.), 40u);
  EXPECT_EQ(count(state.held, lattice, 0.007), 0u); // the sides are free
  EXPECT_NEAR(count(state.removed, lattice, 100.) * lattice.site_area(), M_PI * 16e-6, 4e-6);

  input.hole_radius = 0.;
  input.notch_length = 5e-3;
  EXPECT_EQ(count(lattice_state(input, lattice).removed, lattice, 100.), 6u); // sites at 0, 1, ... 5 mm
}

TEST(Case, NamesTheEntryThatDoesNotFit)
{
  for (const sentences::Sentence &own : sentences::of({"case", "lattice", "continuum"}))
  {
    Case input;
    const bool is_lattice = own.kind == "lattice", is_continuum = own.kind == "continuum";
    const Lines found = small_case::problems(sentences::entries(own.input), input, is_lattice ? sheet : Lines(),
                                             [&](const Case &of, Parameters &p)
                                             {
                                               if (is_lattice)
                                                 require_lattice_sheet(of, p, "`it`");
                                               if (is_continuum)
                                                 of.continuum.require_equilibrium(p, of, "`it`");
                                             });
    SCOPED_TRACE(testing::PrintToString(own) + testing::PrintToString(found));
    ASSERT_EQ(found.size(), own.message == "accepted" ? 0u : 1u);
    if (!found.empty())
    {
      EXPECT_NE(found[0].find(own.message), std::string::npos);
      EXPECT_TRUE(own.kind == "case" || found[0].find("`it`") != std::string::npos);
    }
  }
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

TEST(FieldFunction, GradientsOfExpressionsAreOfFourthOrder)
{
  FieldCase sine;
  sine.x = "sin(100 * x)";
  const double extent = 0.02;
  // Five-point formula: h^4 / 30 times the fifth derivative 100^5, and round-off over h.
  const double h = 1e-3 * extent;
  EXPECT_NEAR(FieldFunction(sine, extent).gradient({0.003, 0.}, 0)[0], 100. * std::cos(0.3),
              std::pow(h, 4) * 1e10 / 30. + 1e-15 / h);
}

} // namespace lattice_sheet_test
