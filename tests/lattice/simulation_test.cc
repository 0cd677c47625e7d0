#include "lattice/simulation.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/site_fields.h"
#include "tests/lattice/sheets.h"

namespace
{

using namespace lattice;

const Eigen::Matrix2d loading = sheets::stretched(1.4, 1.4);

// Objects keep a copy of their material, whatever happens to the caller's.
TEST(Simulation, KeepsItsMaterial)
{
  const TriangularLattice sheet = sheets::square(8);
  Material callers = sheets::rubber();
  const State state = homogeneous_state(sheet, callers, loading, Edges::held);
  Simulation simulation(sheet, callers, state, 1e-9, Fracture(sheet, callers, 1.3, NoToughening{}, loading));
  const SiteEvaluator evaluator(sheet, callers);
  const double elastic = simulation.energies().elastic;
  const std::size_t middle = sheet.index(4, 3);
  const double density = evaluator.at(state, middle).strain_energy_density;

  callers.density = 1.;
  callers.nearest.law = LinearBond(1.);
  callers.nearest.area_factor = 7.;
  callers.next_nearest->law = LinearBond(1.);
  EXPECT_EQ(simulation.energies().elastic, elastic);
  EXPECT_EQ(simulation.material().density, sheets::rubber().density);
  EXPECT_EQ(evaluator.at(state, middle).strain_energy_density, density);
  // All bonds are at 1.4 of 1.3: what they held is what they have lost, but for the work of one step.
  simulation.step();
  EXPECT_EQ(simulation.energies().elastic, 0.);
  EXPECT_NEAR(simulation.energies().broken, elastic, 1e-6 * elastic);
}

TEST(Simulation, RefusesASecondContactAndSecondEndLoads)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const ContactLaw law = contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 1.);
  const auto end = EndLoads::End::free;
  const Edges edges{false, false, true, true};
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, loading, edges), 1e-9,
                        Fracture(sheet, material, 3., NoToughening{}, loading));
  simulation.load_ends(loading, end, end);
  EXPECT_THROW(simulation.load_ends(loading, end, end), std::logic_error);
  simulation.let_touch(law);
  EXPECT_THROW(simulation.let_touch(law), std::logic_error);
  EXPECT_NO_THROW(simulation.step());
}

// Sites at a cut lack bonds as those at an end do.
TEST(Simulation, LoadsTheEndsOfAnUnbrokenSheetAlone)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const Edges edges{false, false, true, true};
  const State state = homogeneous_state(sheet, material, loading, edges);
  const auto end = EndLoads::End::free;
  Simulation cut(sheet, material, state, 1e-9, Fracture(sheet, material, 3., NoToughening{}, loading));
  cut.cut(sheets::middle_row(sheet, 3, 2));
  EXPECT_THROW(cut.load_ends(loading, end, end), std::logic_error);
  Simulation broken(sheet, material, state, 1e-9, Fracture(sheet, material, 1.3, NoToughening{}, loading));
  EXPECT_GT(broken.step().size(), 0u);
  EXPECT_THROW(broken.load_ends(loading, end, end), std::logic_error);
}

} // namespace
