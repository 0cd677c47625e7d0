#include <cmath>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "tests/lattice/sheets.h"

namespace toughening_strip_test
{

using namespace latcon;

using namespace lattice;

// Bonds are toughened in a strip that follows the tip: after every step exactly those behind its boundary are. The
// tip advances by several spacings.
TEST(Fracture, ToughensAllBondsBehindARunningTip)
{
  for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
  {
    const double distance = 2.2 * sheets::spacing, side = 40. * sheets::spacing;
    const TriangularLattice sheet(sheets::spacing, side, side, orientation);
    const Material material = sheets::rubber();
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
    State state = homogeneous_state(sheet, material, F, Edges::held);
    add_noise(state, sheet, 0.01 * sheets::spacing, 1);
    Simulation simulation(sheet, material, std::move(state), TimeStepping{4e-6, 7},
                          Fracture(sheet, material, 3.05, BehindTipToughening{distance, 2.}, F));
    std::vector<std::size_t> seed;
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      if (sheet.is_site(place) && std::abs(sheet.reference(place).y()) < 0.6 * sheets::spacing &&
          sheet.reference(place).x() > 4. * sheets::spacing && sheet.reference(place).x() < 9. * sheets::spacing)
        seed.push_back(place);
    simulation.cut(seed);
    ASSERT_TRUE(simulation.tip());
    double first_tip = 0., tip = 0.;
    for (int step = 0; step <= 220; ++step)
    {
      if (step > 0)
        simulation.step();
      tip = sheet.reference(*simulation.tip()).x();
      if (step == 0)
        first_tip = tip;
      std::size_t wrong = 0;
      for_each_bond(simulation.state(), sheet,
                    [&](const Bond &bond)
                    {
                      const double midpoint = sheet.reference(bond.near).x() + 0.5 * sheet.bond_vector(bond.kind).x();
                      wrong +=
                        simulation.state().bonds.toughened(bond.near, bond.kind) != (midpoint < tip - distance) ? 1 : 0;
                    });
      ASSERT_EQ(wrong, 0u) << "after step " << step << ", tip at " << tip;
    }
    EXPECT_GT(tip, first_tip + 8. * sheets::spacing);
  }
}

} // namespace toughening_strip_test
