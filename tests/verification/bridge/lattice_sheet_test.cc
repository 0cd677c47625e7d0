// The lattice of a case has the same edges, hole and notch as its finite elements; otherwise the case is refused, with
// the entry to change.
#include "verification/bridge/lattice_sheet.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/errors.h"

namespace lattice_sheet_test
{

using namespace latcon;
using namespace bridge;
using namespace input;

using Lines = std::vector<std::string>;
using Check = void (*)(const Case &, Parameters &, const std::string &);

const Lines sheet = {"Sheet/spacing=1 mm",        "Sheet/length=20 mm",      "Sheet/height=20 mm",
                     "Material/density=1000",     "Loading/strain x=0",      "Loading/strain y=0.2",
                     "Right edge/condition=free", "Left edge/condition=free"};

// Reads the case with these entries instead of those above.
Case read(const Lines &overrides, Parameters &parameters)
{
  Case input;
  input.declare(parameters);
  parameters.read_text("", "a.prm");
  Lines all = overrides;
  for (const std::string &entry : sheet)
    if (std::none_of(overrides.begin(), overrides.end(),
                     [&](const std::string &other)
                     { return other.substr(0, other.find('=')) == entry.substr(0, entry.find('=')); }))
      all.push_back(entry);
  parameters.read_overrides(all);
  input.check(parameters);
  return input;
}

Lines problems(const Lines &overrides, Check check = require_lattice_sheet)
{
  Parameters parameters;
  check(read(overrides, parameters), parameters, "`it`");
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

void expect_refused(const std::string &entry, const Lines &overrides)
{
  const Lines found = problems(overrides);
  ASSERT_EQ(found.size(), 1u) << entry << "\n"
                              << (found.empty() ? "no problem" : latcon::support::InputError(found).what());
  EXPECT_NE(found[0].find(entry), std::string::npos) << found[0];
  EXPECT_NE(found[0].find("`it`"), std::string::npos) << found[0];
}

std::size_t count(const lattice::SiteFlags &flags, const lattice::TriangularLattice &lattice, double y)
{
  std::size_t n = 0;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    n += lattice.is_site(place) && flags[place] != 0 && std::abs(lattice.reference(place).y()) <= y;
  return n;
}

TEST(LatticeSheet, HasTheEdgesAndTheHoleOfTheCase)
{
  Parameters parameters;
  Case input = read({"Sheet/hole radius=4 mm"}, parameters);
  const lattice::TriangularLattice lattice = input.lattice();
  const lattice::State state = lattice_state(input, lattice);
  EXPECT_GT(count(state.held, lattice, 100.), 40u);
  EXPECT_EQ(count(state.held, lattice, 0.007), 0u); // the sides are free
  EXPECT_NEAR(count(state.removed, lattice, 100.) * lattice.site_area(), M_PI * 16e-6, 4e-6);

  input.hole_radius = 0.;
  input.notch_length = 5e-3;
  EXPECT_EQ(count(lattice_state(input, lattice).removed, lattice, 100.), 6u); // sites at 0, 1, ... 5 mm
}

TEST(LatticeSheet, IsPeriodicWhereItsEdgesAre)
{
  const Lines both = {"Left edge/condition=periodic", "Right edge/condition=periodic"};
  EXPECT_TRUE(problems(both).empty());
  Parameters parameters;
  const Case input = read(both, parameters);
  EXPECT_TRUE(input.lattice().periodic().x);
  EXPECT_FALSE(input.lattice().periodic().y);
  // The finite elements keep the undeformed period in equilibrium, and start with the stretched one in motion.
  expect_refused("Loading/strain x", {both[0], both[1], "Loading/strain x=0.1"});
  EXPECT_TRUE(problems({both[0], both[1], "Loading/strain x=0.1", "Lattice/solution=motion"}).empty());
}

TEST(LatticeSheet, RefusesWhatTheLatticeCannotDo)
{
  EXPECT_TRUE(problems({"Sheet/notch length=5 mm"}).empty());
  EXPECT_TRUE(problems({"Continuum/gradient=lattice", "Top edge/normal gradient=loading"}).empty());
  expect_refused("Top edge/displacement x", {"Top edge/displacement x=free"});
  expect_refused("Top edge/displacement y", {"Top edge/displacement y=1e-3*x"});
  expect_refused("Left edge/traction y", {"Left edge/traction y=1"});
  expect_refused("Top edge/double traction x", {"Continuum/gradient=lattice", "Top edge/double traction x=1"});
  expect_refused("Top edge/normal gradient", {"Continuum/gradient=lattice", "Top edge/normal gradient=clamped"});
  expect_refused("Inner edge/condition", {"Sheet/hole radius=4 mm", "Inner edge/condition=held"});
  expect_refused("Continuum/mesh file", {"Continuum/mesh file=a.msh"});
  expect_refused("Body force/force y", {"Body force/force y=1"});
  const Lines free = {"Bottom edge/condition=free", "Top edge/condition=free", "Continuum/solution=motion"};
  expect_refused("Left edge/condition", free);
  const std::string motion = "Lattice/solution=motion";
  EXPECT_TRUE(problems({free[0], free[1], free[2], motion}).empty());
  expect_refused("Initial state/velocity x", {motion, "Initial state/velocity x=1"});
  const Lines roller = {"Top edge/displacement x=free", motion};
  EXPECT_TRUE(problems(roller).empty());
  EXPECT_TRUE(problems({"Loading/history times=1", "Loading/history strain y=2", motion}).empty());
  expect_refused("Top edge/displacement x", {"Top edge/displacement x=free", "Top edge/displacement y=0", motion});
  expect_refused("Initial state/base", {motion, "Initial state/base=undeformed"});
}

TEST(LatticeSheet, ThatBreaksIsWholeAndHeld)
{
  const Check check = [](const Case &input, Parameters &p, const std::string &) { require_fracture_case(input, p); };
  const std::string stretch = "Fracture/breaking stretch=3", end = "Time/end=1";
  const Lines found = problems({"Sheet/hole radius=4 mm", stretch, end}, check);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NE(found[0].find("Sheet/hole radius"), std::string::npos);
  EXPECT_NE(found[1].find("Left edge/condition"), std::string::npos);
  EXPECT_NE(found[2].find("Right edge/condition"), std::string::npos);
  const std::string left = "Left edge/condition=held", right = "Right edge/condition=held";
  EXPECT_EQ(problems({left, right, "Top edge/displacement x=0", stretch, end}, check).size(), 1u);
}

} // namespace lattice_sheet_test
