// A sheet that ranks share against the same sheet on one rank, bit by bit.
#include <cstdlib>
#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "../nonlocal_sheets.h"
#include "tests/lattice/running_crack.h"

namespace shared_simulation_test
{

using namespace latcon;

using namespace lattice;

TEST(Ranks, AreAsManyAsTheTestWants)
{
  int n = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  EXPECT_EQ(std::to_string(n), std::getenv("LATCON_RANKS"));
}

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
  for (const std::size_t place : sheet.sites())
  {
    ASSERT_EQ(state.lost_bonds[place], alone.lost_bonds[place]);
    ASSERT_EQ(state.removed[place], alone.removed[place]);
    ASSERT_EQ(state.held[place], alone.held[place]);
    if (!band.is_first() && !band.owns(place))
      continue;
    ASSERT_EQ(state.position.at(place), alone.position.at(place)) << place;
    ASSERT_EQ(state.velocity.at(place), alone.velocity.at(place));
    for (std::size_t kind = 0; kind < alone.bonds.n_kinds(); kind += BondStates::kinds_per_word)
      ASSERT_EQ(state.bonds.words(kind)[place], alone.bonds.words(kind)[place]);
    if (band.owns(place))
    {
      ASSERT_EQ(state.acceleration.x[place], alone.acceleration.x[place]);
      ASSERT_EQ(state.acceleration.y[place], alone.acceleration.y[place]);
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
  double length = 40.; // in spacings
  int steps = 3000;
  std::optional<double> scatter = {}; // of a stencil; none: the triangular lattice
  std::size_t divided = 0;            // steps that are at least divided

  TriangularLattice sheet() const
  {
    if (scatter)
      return nonlocal_sheets::sheet(Grid::Kind::triangular, 2., length, height, 30., orientation, *scatter);
    return {sheets::spacing, length * sheets::spacing, height * sheets::spacing, orientation};
  }
};

std::unique_ptr<Simulation> crack_of(const Variant &variant, const RowPartition &band)
{
  running_crack::Choice choice;
  choice.material = variant.material;
  choice.stepping = 0.9 * time_step_limits(band.lattice(), variant.material, 0.3).combined;
  choice.toughening = variant.toughening;
  choice.contact = variant.contact;
  choice.right = variant.right;
  return running_crack::start(band, choice);
}

using SharedCrack = testing::TestWithParam<Variant>;

constexpr double behind = 4. * sheets::spacing;
// Nearest neighbours so stiff that bonds recoil far below the stretch that the step is made for: which step is divided
// into how many parts is agreed on.
const Material recoiling{
  944., {MooneyRivlinBond{1e10, 1.5e5}, 0.72, 65.625}, Shell{MooneyRivlinBond{1e5, 1.5e5}, 0.81, 196.875}};
INSTANTIATE_TEST_SUITE_P(
  LatticeRanks, SharedCrack,
  testing::Values(
    Variant{Orientation::rows_along_crack, 24., Toughening{3., 0., behind}, 3., EndLoads::End::held},
    Variant{Orientation::rows_across_crack, 24., Toughening{3., 0., behind}, 5., EndLoads::End::absorbing},
    Variant{Orientation::rows_along_crack, 24., Toughening{2., 0.8}, 0., EndLoads::End::absorbing},
    Variant{Orientation::rows_along_crack, 16., Toughening{}, 0., EndLoads::End::held, sheets::rubber_from_outside()},
    Variant{Orientation::rows_along_crack, 16., Toughening{3., 0., behind}, 3., EndLoads::End::held,
            sheets::rubber_with_memory()},
    Variant{Orientation::rows_across_crack, 16., Toughening{3., 0., behind}, 3., EndLoads::End::held,
            sheets::disordered_rubber()},
    Variant{Orientation::rows_along_crack, 16., Toughening{2., 0.8}, 3., EndLoads::End::absorbing,
            sheets::disordered_rubber_of_three_shells()},
    // Nine rows: bands of one or two for five ranks.
    Variant{Orientation::rows_along_crack, 7., Toughening{}, 5., EndLoads::End::free},
    Variant{Orientation::rows_along_crack,
            16.,
            Toughening{3., 0., behind},
            1.,
            EndLoads::End::held,
            recoiling,
            24.,
            110,
            {},
            11},
    // Rows that bonds of rings reach, of ranks that do not all have as many.
    Variant{Orientation::rows_along_crack, 18., Toughening{3., 0., behind}, 1.2, EndLoads::End::held,
            sheets::disordered_rubber(), 22., 75, 0.},
    Variant{Orientation::rows_along_crack, 18., Toughening{3., 0., behind}, 1.2, EndLoads::End::held,
            sheets::disordered_rubber(), 22., 75, 0.5}));

// A snapshot, which is local to each rank, included.
TEST_P(SharedCrack, HasTheBitsOfOneRank)
{
  const Variant &variant = GetParam();
  const TriangularLattice sheet = variant.sheet();
  const auto shared = crack_of(variant, RowPartition(sheet, MPI_COMM_WORLD)), alone = crack_of(variant, sheet);
  Simulation &ours = *shared, &theirs = *alone;
  std::size_t touching = 0;
  for (int step = 0; step < variant.steps; ++step)
  {
    if (step == variant.steps / 3)
    {
      Snapshot snapshot;
      ours.save(snapshot);
      for (int later = 0; later < 50; ++later)
        ours.step();
      ours.restore(snapshot);
    }
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
      ASSERT_EQ(broken[i].X, expected[i].X);
      ASSERT_EQ(broken[i].Y, expected[i].Y);
    }
    ASSERT_EQ(ours.tip(), theirs.tip());
    if (variant.contact > 0.)
      touching += theirs.contact()->last().size();
    if (step % 500 == 0)
      expect_same_energies(ours.energies(), theirs.energies());
  }
  EXPECT_GT(theirs.n_broken(), 30u) << "too quiet to show anything";
  EXPECT_GE(theirs.n_divided_steps(), variant.divided);
  EXPECT_EQ(ours.n_broken(), theirs.n_broken());
  if (variant.contact > 0. && variant.steps > 1000)
  {
    EXPECT_GT(touching, 200u) << "too quiet to show anything";
  }
  ASSERT_TRUE(theirs.tip());
  const std::size_t tip = *theirs.tip();
  EXPECT_EQ(ours.position(tip), theirs.state().position.at(tip));
  expect_same_energies(ours.energies(), theirs.energies());
  expect_same_state(ours, theirs.state());
}

// Bonds of sites at an edge that other ranks move are cut, as after a restart: held sites are no tip there either.
TEST(SharedHeldSites, AreNoTip)
{
  const TriangularLattice sheet = sheets::square(12.);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.2, 1.2);
  const RowPartition band(sheet, MPI_COMM_WORLD);
  State state = homogeneous_state(band, material, F, Edges::held);
  Fracture fracture(band, material, 3., Toughening{}, F);
  for (const std::size_t row : {std::size_t{0}, sheet.rows() - 1})
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
      state.lost_bonds[sheet.index(row, column)] = 5;
  const std::size_t inside = sheet.index(sheet.rows() / 2, 4);
  state.lost_bonds[inside] = 5;
  fracture.locate_tip(state);
  EXPECT_EQ(fracture.tip(), inside);
}

// Without breaking: both periodicities, from a state of rest and from one in motion.
using SharedMotion = testing::TestWithParam<Periodic>;
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
      VectorField velocity(sheet.n_places());
      for (std::size_t place = 0; place < sheet.n_places(); ++place)
        velocity.set(place, {std::sin(static_cast<double>(place)), std::cos(static_cast<double>(place))});
      for (Simulation *simulation : {ours.get(), theirs.get()})
      {
        simulation->set_velocities(velocity);
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
