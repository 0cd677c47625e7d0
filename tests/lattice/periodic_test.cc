// A periodic sheet is a piece of an endless one: nobody on it can tell where its edge is.
#include <gtest/gtest.h>

#include "lattice/energy.h"
#include "lattice/relaxation.h"
#include "support/largest_error.h"
#include "tests/lattice/sheets.h"

namespace periodic_test
{

using namespace latcon;

using namespace lattice;

constexpr Orientation orientations[] = {Orientation::rows_along_crack, Orientation::rows_across_crack};
constexpr Periodic both{true, true};

// About n by n sites, periodic as asked.
TriangularLattice periodic_square(double n, Orientation orientation, Periodic periodic)
{
  return {sheets::spacing, n * sheets::spacing, n * sheets::spacing, orientation, periodic};
}

TEST(PeriodicLattice, HasEdgesOnlyWhereItIsNotPeriodic)
{
  for (const Orientation orientation : orientations)
    for (const Periodic periodic : {Periodic{true, false}, Periodic{false, true}})
    {
      const TriangularLattice sheet = periodic_square(10., orientation, periodic);
      const Material material = sheets::rubber();
      const State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
      for (const std::size_t place : sheets::sites(sheet))
      {
        const Eigen::Vector2d X = sheet.reference(place);
        const double from_edge =
          periodic.x ? 0.5 * sheet.height() - std::abs(X.y()) : std::min(X.x(), sheet.length() - X.x());
        // Bonds reach sqrt3 d across rows that run along the edge, 1.5 d across those that do not.
        EXPECT_EQ(state.held[place] != 0, from_edge < 1.4 * sheets::spacing);
      }
    }
}

// The smallest cell, two rows of two sites, is bonded to itself over and over. Laid out three times along and across
// without anything repeating, it must feel the same forces.
TEST(PeriodicLattice, SmallestCellFeelsWhatItsCopiesFeelInALargeSheet)
{
  for (const Orientation orientation : orientations)
  {
    const Material material = sheets::rubber();
    const bool along_x = orientation == Orientation::rows_along_crack;
    const double pitch = std::sqrt(3.) / 2.;
    const auto sheet_of = [&](double columns, double rows)
    {
      const double d = sheets::spacing;
      return along_x ? TriangularLattice(d, columns * d, rows * pitch * d, orientation, both)
                     : TriangularLattice(d, rows * pitch * d, columns * d, orientation, both);
    };
    const TriangularLattice cell = sheet_of(2., 2.), large = sheet_of(6., 6.);
    ASSERT_EQ(cell.n_sites(), 4u);
    ASSERT_EQ(large.n_sites(), 36u);
    const Eigen::Matrix2d F = sheets::stretched(1.3, 1.6);
    State small = homogeneous_state(cell, material, F, Edges::held);
    add_noise(small, cell, 0.1 * sheets::spacing, 3);
    for (const std::size_t place : sheets::sites(cell))
    {
      small.vx[place] = 0.3 * static_cast<double>(place % 5);
      small.vy[place] = -0.2 * static_cast<double>(place % 7);
    }
    update_images(small, cell);
    State copies = homogeneous_state(large, material, F, Edges::held);
    const auto original = [&](std::size_t place)
    { return cell.index(large.row_of(place) % 2, large.column_of(place) % 2); };
    for (const std::size_t place : sheets::sites(large))
    {
      const std::size_t from = original(place);
      const Eigen::Vector2d at_rest = F * cell.reference(from);
      copies.x[place] += small.x[from] - at_rest.x();
      copies.y[place] += small.y[from] - at_rest.y();
      copies.vx[place] = small.vx[from];
      copies.vy[place] = small.vy[from];
    }
    update_images(copies, large);
    Forces in_cell(cell, material), in_large(large, material);
    in_cell.evaluate(small, small.vx, small.vy);
    in_large.evaluate(copies, copies.vx, copies.vy);
    double largest = 0.;
    for (const std::size_t place : sheets::sites(cell))
      largest = support::largest_of({largest, std::abs(in_cell.fx()[place])});
    for (const std::size_t place : sheets::sites(large))
    {
      EXPECT_NEAR(in_large.fx()[place], in_cell.fx()[original(place)], 1e-12 * largest);
      EXPECT_NEAR(in_large.fy()[place], in_cell.fy()[original(place)], 1e-12 * largest);
    }
    EXPECT_NEAR(in_large.viscous_power(), 9. * in_cell.viscous_power(), 1e-12 * in_large.viscous_power());
    EXPECT_NEAR(elastic_energy(copies, large, material), 9. * elastic_energy(small, cell, material),
                1e-12 * elastic_energy(copies, large, material));
  }
}

// A sheet that moves keeps its energy and momentum, which it would not with images that lag behind.
TEST(PeriodicLattice, MotionKeepsEnergyAndMomentum)
{
  const Material material = sheets::rubber(0.);
  const TriangularLattice sheet = periodic_square(10., Orientation::rows_along_crack, both);
  State state = homogeneous_state(sheet, material, sheets::stretched(1.5, 1.5), Edges::held);
  add_noise(state, sheet, 0.02 * sheets::spacing, 7);
  Simulation simulation(sheet, material, std::move(state), 1e-7);
  const double before = simulation.energies().elastic;
  for (int step = 0; step < 2000; ++step)
    simulation.step();
  const EnergyBalance after = simulation.energies();
  EXPECT_GT(after.kinetic, 0.);
  // (omega h)^2 / 8 of the energy in motion, omega h < 0.1 for the shortest waves.
  EXPECT_NEAR(after.elastic + after.kinetic, before, 2e-3 * after.kinetic);
  double px = 0., py = 0., scale = 0.;
  for (const std::size_t place : sheets::sites(sheet))
  {
    px += simulation.state().vx[place];
    py += simulation.state().vy[place];
    scale += std::abs(simulation.state().vx[place]);
  }
  EXPECT_LT(std::abs(px) + std::abs(py), 1e-11 * scale);
}

TEST(PeriodicLattice, RelaxesToTheHomogeneousState)
{
  const Material material = sheets::rubber();
  const TriangularLattice sheet = periodic_square(10., Orientation::rows_across_crack, both);
  State state = homogeneous_state(sheet, material, sheets::stretched(1.5, 1.5), Edges::held);
  const double homogeneous = elastic_energy(state, sheet, material);
  add_noise(state, sheet, 0.05 * sheets::spacing, 7);
  EXPECT_GT(elastic_energy(state, sheet, material), homogeneous * (1. + 1e-6));
  relax(state, sheet, material, 1e-12 * 5e5 * sheets::spacing);
  EXPECT_NEAR(elastic_energy(state, sheet, material), homogeneous, 1e-13 * homogeneous);
}

TEST(PeriodicLattice, RefusesToBreak)
{
  const TriangularLattice sheet = periodic_square(10., Orientation::rows_along_crack, {true, false});
  EXPECT_THROW(Fracture(sheet, sheets::rubber(), 3., NoToughening{}, Eigen::Matrix2d::Identity()),
               std::invalid_argument);
}

TEST(Edges, HoldOnlyThoseThatAreAskedFor)
{
  for (const Orientation orientation : orientations)
  {
    const TriangularLattice sheet = sheets::square(12., orientation);
    const Material material = sheets::rubber();
    const State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), {false, true, false, false});
    for (const std::size_t place : sheets::sites(sheet))
    {
      const double from_right = sheet.length() - sheet.reference(place).x();
      EXPECT_EQ(state.held[place] != 0, from_right < 1.4 * sheets::spacing);
    }
  }
}

} // namespace periodic_test
