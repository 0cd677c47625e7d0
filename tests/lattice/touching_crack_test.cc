// Contact in a running crack.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>
#include <omp.h>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "tests/lattice/sheets.h"

namespace touching_crack_test
{

using namespace latcon;

using namespace lattice;

// A crack in a small sheet whose flanks and debris touch.
struct TouchingCrack
{
  explicit TouchingCrack(double time_step_factor = 0.9)
    : sheet(sheets::spacing, 70. * sheets::spacing, 50. * sheets::spacing, Orientation::rows_along_crack),
      material(sheets::rubber())
  {
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
    State state = homogeneous_state(sheet, material, F, Edges::held);
    add_noise(state, sheet, 0.05 * sheets::spacing, 1);
    simulation = std::make_unique<Simulation>(sheet, material, std::move(state),
                                              time_step_factor * time_step_limits(sheet, material, 0.3).combined,
                                              Fracture(sheet, material, 3.05, NoToughening{}, F));
    simulation->enable_contact(contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 1.));
    simulation->cut(sheets::middle_row(sheet, 6, 8));
  }
  // @return the largest number of pairs that touched at once
  std::size_t run(int steps)
  {
    std::size_t most = 0;
    for (int step = 0; step < steps; ++step)
    {
      simulation->step();
      most = std::max(most, simulation->contact()->n_touching());
    }
    return most;
  }
  TriangularLattice sheet;
  Material material;
  std::unique_ptr<Simulation> simulation;
};

TEST(Contact, LedgerClosesThroughACrackWhoseDebrisTouches)
{
  TouchingCrack crack;
  EXPECT_GT(crack.run(6000), 5u);
  const EnergyBalance e = crack.simulation->energies();
  EXPECT_GT(e.contact, 1e-4 * e.initial);
  EXPECT_LT(std::abs(e.imbalance()), 1e-4 * e.initial);
}

TEST(Contact, GivesTheSameBitsOnOneThreadAndOnTwo)
{
  const auto positions = [](int threads)
  {
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    TouchingCrack crack;
    EXPECT_GE(crack.sheet.n_places(), min_places_for_threads);
    EXPECT_GT(crack.run(4000), 1u);
    omp_set_num_threads(before);
    return crack.simulation->state().x;
  };
  const Field one = positions(1), two = positions(2);
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(double)), 0);
}

} // namespace touching_crack_test
