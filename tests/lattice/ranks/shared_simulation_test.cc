// A sheet that ranks share against the same sheet on one rank, bit by bit.
#include <cstring>

#include <gtest/gtest.h>

#include "../nonlocal_sheets.h"
#include "lattice/seed.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"

namespace shared_simulation_test
{

using namespace latcon;

using namespace lattice;

void expect_same_energies(const EnergyBalance &shared, const EnergyBalance &alone)
{
  for (const auto energy : sheets::energies)
    EXPECT_EQ(std::memcmp(&(shared.*energy), &(alone.*energy), sizeof(double)), 0)
      << shared.*energy << ", alone " << alone.*energy;
}

// Own rows on every rank, the whole sheet on the first, and everywhere what is known everywhere.
void expect_same_state(Simulation &shared, const State &alone)
{
  const TriangularLattice &sheet = shared.lattice();
  const RowPartition &band = shared.band();
  const State &state = shared.gather();
  for (const std::size_t place : sheets::sites(sheet))
  {
    ASSERT_EQ(state.lost_bonds[place], alone.lost_bonds[place]);
    ASSERT_EQ(state.removed[place], alone.removed[place]);
    ASSERT_EQ(state.held[place], alone.held[place]);
    if (!band.is_first() && !band.owns(place))
      continue;
    ASSERT_EQ(state.x[place], alone.x[place]) << place;
    ASSERT_EQ(state.y[place], alone.y[place]);
    ASSERT_EQ(state.vx[place], alone.vx[place]);
    ASSERT_EQ(state.vy[place], alone.vy[place]);
    for (std::size_t kind = 0; kind < alone.bonds.n_kinds(); kind += BondStates::kinds_per_word)
      ASSERT_EQ(state.bonds.words(kind)[place], alone.bonds.words(kind)[place]);
    if (band.owns(place))
    {
      ASSERT_EQ(state.ax[place], alone.ax[place]);
      ASSERT_EQ(state.ay[place], alone.ay[place]);
    }
  }
}

struct Variant
{
  Orientation orientation;
  double height; // in spacings
  Toughening toughening;
  double contact; // distance in spacings, so large that sites on one flank touch; 0: none
  EndLoads::End right;
  Material material = sheets::rubber();
};

struct Crack
{
  Crack(const Variant &variant, const RowPartition &band, const Material &material)
  {
    const TriangularLattice &sheet = band.lattice();
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.9);
    State state = homogeneous_state(band, material, F, {true, variant.right == EndLoads::End::held, true, true});
    add_noise(state, band, 0.05 * sheets::spacing, 1);
    simulation = std::make_unique<Simulation>(band, material, std::move(state),
                                              0.9 * time_step_limits(sheet, material, 0.3).combined,
                                              Fracture(band, material, 3.05, variant.toughening, F));
    if (variant.right != EndLoads::End::held)
      simulation->load_ends(F, EndLoads::End::held, variant.right);
    if (variant.contact > 0.)
      simulation->enable_contact(
        contact_like_nearest_bond(sheet, material, variant.contact * sheets::spacing, 0.1, 0.1));
    // A line of sites at Y = 0 along X, in one row or one in every second row.
    std::vector<std::size_t> seed;
    for (std::size_t n = 4; n < 12; ++n)
      if (variant.orientation == Orientation::rows_along_crack)
        seed.push_back(sheet.index(sheet.rows() / 2, n));
      else if (n % 2 == 0)
        seed.push_back(sheet.index(n, sheet.columns() / 2));
    simulation->cut(seed);
  }
  std::unique_ptr<Simulation> simulation;
};

class SharedCrack : public testing::TestWithParam<Variant>
{
};

constexpr double behind = 4. * sheets::spacing;
INSTANTIATE_TEST_SUITE_P(
  LatticeRanks, SharedCrack,
  testing::Values(
    Variant{Orientation::rows_along_crack, 24., BehindTipToughening{behind, 3.}, 3., EndLoads::End::held},
    Variant{Orientation::rows_across_crack, 24., BehindTipToughening{behind, 3.}, 5., EndLoads::End::absorbing},
    Variant{Orientation::rows_along_crack, 24., RetractionToughening{0.8, 2.}, 0., EndLoads::End::absorbing},
    Variant{Orientation::rows_along_crack, 16., NoToughening{}, 0., EndLoads::End::held, sheets::rubber_from_outside()},
    Variant{Orientation::rows_along_crack, 16., BehindTipToughening{behind, 3.}, 3., EndLoads::End::held,
            sheets::rubber_with_memory()},
    Variant{Orientation::rows_across_crack, 16., BehindTipToughening{behind, 3.}, 3., EndLoads::End::held,
            sheets::disordered_rubber()},
    Variant{Orientation::rows_along_crack, 16., RetractionToughening{0.8, 2.}, 3., EndLoads::End::absorbing,
            sheets::disordered_rubber_of_three_shells()},
    // Nine rows: bands of one or two for five ranks.
    Variant{Orientation::rows_along_crack, 7., NoToughening{}, 5., EndLoads::End::free}));

TEST_P(SharedCrack, HasTheBitsOfOneRank)
{
  const Variant &variant = GetParam();
  const TriangularLattice sheet(sheets::spacing, 40. * sheets::spacing, variant.height * sheets::spacing,
                                variant.orientation);
  const Material &material = variant.material;
  Crack shared(variant, RowPartition(sheet, MPI_COMM_WORLD), material), alone(variant, sheet, material);
  Simulation &ours = *shared.simulation, &theirs = *alone.simulation;
  std::size_t touching = 0;
  for (int step = 0; step < 3000; ++step)
  {
    const std::vector<BrokenBond> &broken = ours.step(), &expected = theirs.step();
    ASSERT_EQ(broken.size(), expected.size()) << "step " << step;
    for (std::size_t i = 0; i < broken.size(); ++i)
    {
      ASSERT_EQ(broken[i].near, expected[i].near);
      ASSERT_EQ(broken[i].far, expected[i].far);
      ASSERT_EQ(broken[i].kind, expected[i].kind);
      ASSERT_EQ(broken[i].time, expected[i].time);
      ASSERT_EQ(broken[i].stretch, expected[i].stretch);
      ASSERT_EQ(broken[i].energy, expected[i].energy);
      ASSERT_EQ(broken[i].midpoint, expected[i].midpoint);
    }
    ASSERT_EQ(ours.tip(), theirs.tip());
    if (variant.contact > 0.)
      touching += theirs.contact()->n_touching();
    if (step % 500 == 0)
      expect_same_energies(ours.energies(), theirs.energies());
  }
  EXPECT_GT(theirs.n_broken(), 30u) << "too quiet to show anything";
  EXPECT_EQ(ours.n_broken(), theirs.n_broken());
  if (variant.contact > 0.)
  {
    EXPECT_GT(touching, 100u) << "too quiet to show anything";
  }
  ASSERT_TRUE(theirs.tip());
  const std::size_t tip = *theirs.tip();
  EXPECT_EQ(ours.position(tip), Eigen::Vector2d(theirs.state().x[tip], theirs.state().y[tip]));
  expect_same_energies(ours.energies(), theirs.energies());
  expect_same_state(ours, theirs.state());
}

// Rows that bonds of rings reach, of ranks that do not all have as many.
TEST(SharedNonlocalCrack, HasTheBitsOfOneRank)
{
  for (const double scatter : {0., 0.5})
  {
    const TriangularLattice sheet =
      nonlocal_sheets::sheet(Grid::Kind::triangular, 2., 30., 24., 30., Orientation::rows_along_crack, scatter);
    const Material material = sheets::disordered_rubber();
    const Variant variant{Orientation::rows_along_crack, 24., BehindTipToughening{behind, 3.}, 1.2,
                          EndLoads::End::held};
    Crack shared(variant, RowPartition(sheet, MPI_COMM_WORLD), material), alone(variant, sheet, material);
    const std::vector<std::pair<std::size_t, std::size_t>> slit =
      bonds_across(sheet, 4. * sheets::spacing, 12. * sheets::spacing, 0.1 * sheets::spacing);
    for (Simulation *crack : {shared.simulation.get(), alone.simulation.get()})
    {
      crack->cut_bonds(slit);
      for (int step = 0; step < 75; ++step)
        crack->step();
    }
    EXPECT_GT(alone.simulation->n_broken(), 30u) << "too quiet to show anything";
    EXPECT_EQ(shared.simulation->n_broken(), alone.simulation->n_broken());
    EXPECT_EQ(shared.simulation->tip(), alone.simulation->tip());
    expect_same_energies(shared.simulation->energies(), alone.simulation->energies());
    expect_same_state(*shared.simulation, alone.simulation->state());
  }
}

// A snapshot is local to each rank.
TEST(SharedSnapshot, HasTheBitsOfOneRank)
{
  const Variant variant{Orientation::rows_along_crack,
                        16.,
                        BehindTipToughening{behind, 3.},
                        3.,
                        EndLoads::End::held,
                        sheets::disordered_rubber_of_three_shells()};
  const TriangularLattice sheet(sheets::spacing, 40. * sheets::spacing, variant.height * sheets::spacing,
                                variant.orientation);
  Crack shared(variant, RowPartition(sheet, MPI_COMM_WORLD), variant.material), alone(variant, sheet, variant.material);
  Simulation &ours = *shared.simulation, &theirs = *alone.simulation;
  const auto steps = [](Simulation &simulation)
  {
    for (int step = 0; step < 500; ++step)
      simulation.step();
  };
  steps(theirs);
  steps(ours);
  Snapshot snapshot;
  ours.save(snapshot);
  steps(ours);
  ours.restore(snapshot);
  expect_same_state(ours, theirs.state());
  expect_same_energies(ours.energies(), theirs.energies());
  steps(theirs);
  steps(ours);
  EXPECT_GT(theirs.n_broken(), 10u) << "too quiet to show anything";
  EXPECT_EQ(ours.tip(), theirs.tip());
  expect_same_state(ours, theirs.state());
  expect_same_energies(ours.energies(), theirs.energies());
}

// Bonds of sites at an edge that other ranks move are cut, as after a restart: held sites are no tip there either.
TEST(SharedHeldSites, AreNoTip)
{
  const TriangularLattice sheet = sheets::square(12.);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.2, 1.2);
  const RowPartition band(sheet, MPI_COMM_WORLD);
  State state = homogeneous_state(band, material, F, Edges::held);
  Fracture fracture(band, material, 3., NoToughening{}, F);
  for (const std::size_t row : {std::size_t{0}, sheet.rows() - 1})
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
      state.lost_bonds[sheet.index(row, column)] = 5;
  const std::size_t inside = sheet.index(sheet.rows() / 2, 4);
  state.lost_bonds[inside] = 5;
  fracture.locate_tip(state);
  EXPECT_EQ(fracture.tip(), inside);
}

// Nearest neighbours so stiff that bonds recoil far below the stretch that the step is made for: which step is divided
// into how many parts is agreed on.
TEST(SharedDivision, HasTheBitsOfOneRank)
{
  const Material material{
    944., {MooneyRivlinBond{1e10, 1.5e5}, 0.72, 65.625}, Shell{MooneyRivlinBond{1e5, 1.5e5}, 0.81, 196.875}};
  const Variant variant{Orientation::rows_along_crack, 16.,     BehindTipToughening{behind, 3.}, 1.,
                        EndLoads::End::held,           material};
  const TriangularLattice sheet(sheets::spacing, 24. * sheets::spacing, variant.height * sheets::spacing,
                                variant.orientation);
  Crack shared(variant, RowPartition(sheet, MPI_COMM_WORLD), material), alone(variant, sheet, material);
  Simulation &ours = *shared.simulation, &theirs = *alone.simulation;
  for (int step = 0; step < 110; ++step)
  {
    ASSERT_EQ(ours.step().size(), theirs.step().size()) << step;
    ASSERT_EQ(ours.n_divided_steps(), theirs.n_divided_steps()) << step;
  }
  EXPECT_GT(theirs.n_divided_steps(), 10u);
  expect_same_energies(ours.energies(), theirs.energies());
  expect_same_state(ours, theirs.state());
}

// Without breaking: both periodicities, from a state of rest and from one in motion.
class SharedMotion : public testing::TestWithParam<Periodic>
{
};
INSTANTIATE_TEST_SUITE_P(LatticeRanks, SharedMotion,
                         testing::Values(Periodic{false, false}, Periodic{true, false}, Periodic{false, true},
                                         Periodic{true, true}));

TEST_P(SharedMotion, HasTheBitsOfOneRank)
{
  for (const double n : {4., 6., 20.}) // 4: fewer rows than five ranks want, and halos that overlap
    for (const Orientation orientation : {Orientation::rows_along_crack, Orientation::rows_across_crack})
    {
      const TriangularLattice sheet(sheets::spacing, n * sheets::spacing, n * sheets::spacing, orientation, GetParam());
      const Material material = n == 6.   ? sheets::rubber_with_memory()
                                : n == 4. ? sheets::disordered_rubber_of_three_shells()
                                          : sheets::rubber();
      const auto start = [&](const RowPartition &band)
      {
        State state = homogeneous_state(band, material, sheets::stretched(1.3, 1.6), Edges::held);
        add_noise(state, band, 0.05 * sheets::spacing, 3);
        return std::make_unique<Simulation>(band, material, std::move(state), 1e-7);
      };
      const auto ours = start(RowPartition(sheet, MPI_COMM_WORLD)), theirs = start(sheet);
      for (int step = 0; step < 100; ++step)
      {
        ours->step();
        theirs->step();
      }
      expect_same_state(*ours, theirs->state());
      Field vx(sheet.n_places()), vy(sheet.n_places());
      for (std::size_t place = 0; place < vx.size(); ++place)
      {
        vx[place] = std::sin(static_cast<double>(place));
        vy[place] = std::cos(static_cast<double>(place));
      }
      for (Simulation *simulation : {ours.get(), theirs.get()})
      {
        simulation->set_velocities(vx, vy);
        simulation->constrain(
          {held_sites(simulation->state(), sheet), true, true, steady(sheets::stretched(40., 20.))});
        for (int step = 0; step < 100; ++step)
          simulation->step();
      }
      expect_same_energies(ours->energies(), theirs->energies());
      expect_same_state(*ours, theirs->state());
    }
}

} // namespace shared_simulation_test
