#include "lattice/simulation.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/lattice/sheets.h"

namespace simulation_test
{

using namespace latcon;

using namespace lattice;

const Eigen::Matrix2d loading = sheets::stretched(1.4, 1.4);

// Contact and loads are given once; sites at a cut lack bonds as those at an end do.
TEST(Simulation, RefusesASecondContactAndLoadsOnABrokenSheet)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::rubber();
  const auto end = EndLoads::End::free;
  const State state = homogeneous_state(sheet, material, loading, {false, false, true, true});
  const auto start = [&](double breaking_stretch)
  {
    return Simulation(sheet, material, state, 1e-9, Fracture(sheet, material, breaking_stretch, Toughening{}, loading));
  };
  Simulation whole = start(3.), cut = start(3.), broken = start(1.3);
  whole.load_ends(loading, end, end);
  cut.cut(sheets::middle_row(sheet, 3, 2));
  EXPECT_GT(broken.step().size(), 0u);
  for (Simulation *simulation : {&whole, &cut, &broken})
    EXPECT_THROW(simulation->load_ends(loading, end, end), std::logic_error);
  const ContactLaw law = contact_like_nearest_bond(sheet, material, sheets::spacing, 1., 1.);
  whole.enable_contact(law);
  EXPECT_THROW(whole.enable_contact(law), std::logic_error);
  EXPECT_NO_THROW(whole.step());
}

// Sites that are cut out of a moving sheet take their motion with them.
TEST(EnergyBalance, ClosesWhenMovingSitesAreCut)
{
  const TriangularLattice sheet = sheets::square(20);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(1.4, 1.6);
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, F, Edges::held), 2e-8,
                        Fracture(sheet, material, unbreakable, Toughening{}, F));
  VectorField velocity(sheet.n_places());
  for (const std::size_t place : sheet.sites())
    velocity.set(place, {3., -2.});
  simulation.set_velocities(velocity);
  for (int step = 0; step < 20; ++step)
    simulation.step();
  const EnergyBalance before = simulation.energies();
  simulation.cut(sheets::middle_row(sheet, 8, 4));
  const EnergyBalance cut = simulation.energies();
  EXPECT_LT(cut.kinetic, (1. - 1e-3) * before.kinetic);
  EXPECT_NEAR(cut.broken - before.broken, before.elastic + before.kinetic - cut.elastic - cut.kinetic,
              1e-12 * before.initial);
  for (int step = 0; step < 200; ++step)
    simulation.step();
  EXPECT_LT(std::abs(simulation.energies().imbalance()), 1e-6 * before.initial);
}

// A crack in a small sheet with nearest neighbours so stiff that their dashpots hardly damp them: bonds recoil to a
// thirtieth of their rest length. The automatic step, which is stable down to 0.3, is divided there.
struct Recoil
{
  /// @param start time of the initial state [s]
  explicit Recoil(double modulus, double start = 0.)
    : sheet(0.4e-3, 6e-3, 4e-3, Orientation::rows_along_crack), material{
                                                                  944.,
                                                                  {MooneyRivlinBond{modulus, 1.5e5}, 0.72, 65.625},
                                                                  Shell{MooneyRivlinBond{1e5, 1.5e5}, 0.81, 196.875}}
  {
    const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
    const ContactLaw contact = contact_like_nearest_bond(sheet, material, sheet.spacing(), 1., 1.);
    State state = homogeneous_state(sheet, material, F, Edges::held);
    state.time = start;
    simulation = std::make_unique<Simulation>(sheet, material, std::move(state),
                                              0.9 * time_step_limits(sheet, material, 0.3, contact).combined,
                                              Fracture(sheet, material, 3.05, Toughening{3., 0., 4.5e-3}, F));
    simulation->enable_contact(contact);
    simulation->cut(sheets::middle_row(sheet, 3, 2));
  }
  // Until waves have crossed some thirty to fifty spacings.
  void run()
  {
    const double end = 0.4 / std::sqrt(std::get<MooneyRivlinBond>(material.nearest.law).a);
    while (simulation->state().time < end)
    {
      simulation->step();
      for_each_bond(simulation->state(), sheet,
                    [&](const Bond &bond)
                    { shortest = std::min(shortest, stretch(simulation->state(), sheet, bond)); });
    }
    const EnergyBalance e = simulation->energies();
    imbalance = std::abs(e.imbalance()) / e.initial;
  }

  TriangularLattice sheet;
  Material material;
  std::unique_ptr<Simulation> simulation;
  double shortest = 1., imbalance = 0.;
};

// theory.md, eq. (L.24).
TEST(Simulation, DividesStepsInWhichBondsAreTooShort)
{
  for (const double modulus : {1e10, 1e12, 1e15})
  {
    Recoil recoil(modulus);
    recoil.run();
    EXPECT_LT(recoil.shortest, 0.2) << modulus;
    EXPECT_GT(recoil.simulation->n_broken(), 100u) << modulus;
    EXPECT_GT(recoil.simulation->n_divided_steps(), 10u) << modulus;
    EXPECT_LT(recoil.imbalance, 1e-3) << modulus; // 0.8 and more with steps that are not divided
  }
  Recoil rubber(1e5);
  rubber.run();
  EXPECT_EQ(rubber.simulation->n_divided_steps(), 0u);
}

// Two sites of a compressed sheet approach each other: the step is divided if it would make their bond short.
// theory.md, eq. (L.24).
TEST(Simulation, DividesAStepThatMakesABondShort)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = Recoil(1e10).material;
  const std::size_t near = sheet.index(4, 3), far = near + 1;
  const double now = 0.7, h = 1.01 * recoil_step({1., 2}, sheet, material, 0, short_stretch, std::nullopt);
  for (const double then : {0.45, 0.499, 0.501, 0.55, 0.69})
  {
    Simulation simulation(sheet, material,
                          homogeneous_state(sheet, material, now * Eigen::Matrix2d::Identity(), Edges::held),
                          TimeStepping(h, 2));
    VectorField velocity(sheet.n_places());
    velocity.x[near] = 0.5 * (now - then) * sheet.spacing() / h;
    velocity.x[far] = -velocity.x[near];
    simulation.set_velocities(velocity);
    simulation.step();
    EXPECT_EQ(simulation.n_divided_steps(), then < short_stretch ? 1u : 0u) << then;
  }
}

// Sheet of nearest neighbours alone, by hand: e = 3 A0 d psi, half of six bonds pull.
// theory.md, eq. (L.26).
TEST(TimeStep, WatchesBondsByWhatTheyCanLoseInIt)
{
  const TriangularLattice sheet = sheets::square(8);
  const Material material = sheets::nearest_only();
  const Shell &shell = material.nearest;
  const double limit = 3., d = sheet.spacing(), m = site_mass(material, sheet);
  const double site_energy = 3. * cross_section(shell, sheet) * d * energy(shell.law, limit);
  const double of_energy = std::sqrt(8. * site_energy / m) / d, of_forces = 3. * force(shell.law, limit) / 65.625;
  ASSERT_LT(of_forces, of_energy);
  for (const double h : {1e-7, 1e-6})
    EXPECT_NEAR(watched_stretch(h, sheet, material, limit), 0.5 + h * of_forces, 1e-12);
  const Material elastic = sheets::nearest_only(0.);
  EXPECT_NEAR(watched_stretch(1e-7, sheet, elastic, limit), 0.5 + 1e-7 * of_energy, 1e-12);
  EXPECT_DOUBLE_EQ(watched_stretch(1e-4, sheet, material, limit), 0.8); // and no more
  EXPECT_DOUBLE_EQ(watched_stretch(1e-7, sheet, material, unbreakable), 0.8);
}

// Whole steps and divided ones end at the same times, and what breaks in a step breaks until its end. Times so late
// that parts are added with round-off.
TEST(Simulation, KeepsItsClockInDividedSteps)
{
  Recoil recoil(1e10, 1.);
  const double h = recoil.simulation->time_step();
  double time = recoil.simulation->state().time;
  for (int step = 0; step < 100; ++step)
  {
    const double before = time;
    const std::vector<BrokenBond> &broken = recoil.simulation->step();
    time += h;
    ASSERT_EQ(recoil.simulation->state().time, time);
    for (const BrokenBond &bond : broken)
    {
      ASSERT_GT(bond.time, before);
      ASSERT_LE(bond.time, time);
    }
  }
  EXPECT_GT(recoil.simulation->n_divided_steps(), 3u);
  EXPECT_GT(recoil.simulation->n_broken(), 10u);
}

} // namespace simulation_test
