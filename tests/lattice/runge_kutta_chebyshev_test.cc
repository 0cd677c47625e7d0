#include "lattice/runge_kutta_chebyshev.h"

#include <cmath>

#include <gtest/gtest.h>
#include <omp.h>

#include "lattice/simulation.h"
#include "support/largest_error.h"
#include "tests/lattice/plane_modes.h"
#include "tests/lattice/running_crack.h"
#include "tests/lattice/smooth_motion.h"

namespace runge_kutta_chebyshev_test
{

using namespace latcon;

using namespace lattice;
using smooth_motion::distance;
using smooth_motion::run;
using Complex = std::complex<double>;

class Stages : public testing::TestWithParam<unsigned int>
{
};

// Against velocity Verlet with steps so short that its own error is a hundredth of those measured.
TEST_P(Stages, ConvergeAtSecondOrderToTheMotionOfVerlet)
{
  for (const double viscosity : {0., 2.})
  {
    const Material material = sheets::rubber(viscosity);
    const double h = 5e-7;
    const std::size_t n = 160;
    const State exact = run(material, h / 80., 80 * n);
    const auto error = [&](std::size_t refinement) {
      return distance(run(material, {h / static_cast<double>(refinement), GetParam()}, refinement * n), exact);
    };
    const double coarse = error(1), medium = error(2), fine = error(4);
    EXPECT_NEAR(std::log2(coarse / medium), 2., 0.15) << viscosity;
    EXPECT_NEAR(std::log2(medium / fine), 2., 0.15) << viscosity;
  }
}

TEST_P(Stages, KeepTheLedgerAtSecondOrder)
{
  const auto imbalance = [](double h, std::size_t steps)
  {
    double found;
    run(sheets::rubber(2.), {h, GetParam()}, steps, &found);
    return std::abs(found);
  };
  EXPECT_NEAR(std::log2(imbalance(5e-7, 160) / imbalance(2.5e-7, 320)), 2., 0.2);
}

INSTANTIATE_TEST_SUITE_P(RungeKuttaChebyshev, Stages, testing::Values(3u, 8u));

// Damped waves in a periodic sheet, so small that they are linear, are multiplied by R(h lambda) in each step, to
// round-off: all stages, their order, the images of the sites, the polynomial that stability is judged by.
// theory.md, eq. (L.18).
TEST(RungeKuttaChebyshev, MultipliesWavesByItsPolynomial)
{
  const TriangularLattice sheet(sheets::spacing, 8. * sheets::spacing, 8. * sheets::spacing,
                                Orientation::rows_along_crack, {true, true});
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  const Eigen::Vector2d K(2. * M_PI / sheet.length() * 2., 2. * M_PI / sheet.height());
  const plane_modes::PlaneModes waves = plane_modes::of(sheet, material, F, K);
  const double h = 3e-6;
  const unsigned int n_stages = 7, steps = 5;
  const ChebyshevStages stages(n_stages);
  for (Eigen::Index mode = 0; mode < 4; ++mode)
  {
    const Complex factor = std::pow(stages.amplification(h * waves.rates(mode)), steps);
    // As large as linearity allows; the fast modes are motions of high velocity.
    const double amplitude = 1e-7 * sheets::spacing / waves.modes.col(mode).head<2>().norm();
    const State rest = homogeneous_state(sheet, material, F, Edges::free);
    State state = rest;
    const auto wave = [&](std::size_t place, Eigen::Index component, Complex times)
    {
      const Complex phase = std::exp(Complex(0., K.dot(sheet.reference(place))));
      return amplitude * (times * waves.modes(component, mode) * phase).real();
    };
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      if (sheet.is_occupied(place))
      {
        state.x[place] += wave(place, 0, 1.);
        state.y[place] += wave(place, 1, 1.);
        state.vx[place] += wave(place, 2, 1.);
        state.vy[place] += wave(place, 3, 1.);
      }
    Simulation simulation(sheet, material, std::move(state), {h, n_stages});
    for (unsigned int step = 0; step < steps; ++step)
      simulation.step();
    // Quadratic terms are 1e-7 of the wave, rounding of positions of 10 d is 1e-15 over 1e-7, each times some tens.
    const double tolerance = 1e-5 * amplitude * waves.modes.col(mode).tail<2>().norm();
    for (const std::size_t place : sheets::sites(sheet))
    {
      EXPECT_NEAR(simulation.state().vx[place], wave(place, 2, factor), tolerance) << mode;
      EXPECT_NEAR(simulation.state().vy[place], wave(place, 3, factor), tolerance) << mode;
    }
  }
}

// Noise dies out with steps up to what the fastest plane wave allows, and blows up with 1.3 times that.
TEST(RungeKuttaChebyshev, IsStableUpToItsLimitAndNotBeyond)
{
  const TriangularLattice sheet = sheets::square(30);
  for (const Eigen::Matrix2d &F : {sheets::stretched(1., 1.), sheets::stretched(2.3, 2.8)})
  {
    const Material material = sheets::rubber();
    double fastest = 0.;
    for (const Complex &rate : plane_modes::rates(sheet, material, F))
      fastest = support::largest_of({fastest, std::abs(rate)});
    for (const unsigned int n_stages : {2u, 5u, 8u})
    {
      const double limit = ChebyshevStages(n_stages).real_limit() / fastest;
      const auto kinetic = [&](double factor)
      {
        State state = homogeneous_state(sheet, material, F, Edges::held);
        add_noise(state, sheet, 1e-3 * sheets::spacing, 5);
        Simulation simulation(sheet, material, std::move(state), {factor * limit, n_stages});
        simulation.step();
        const double before = simulation.energies().kinetic;
        double growth = 1.;
        for (int step = 0; step < 400 && growth < 1e3; ++step)
        {
          simulation.step();
          growth = simulation.energies().kinetic / before;
        }
        return growth;
      };
      EXPECT_LT(kinetic(1.), 1.) << n_stages;
      EXPECT_FALSE(kinetic(1.3) < 1e3) << n_stages; // beyond, or no number any more
    }
  }
}

// Shorter steps take as few stages as the same limit requires, and damp the same noise.
TEST(RungeKuttaChebyshev, TakesFewerStagesInShorterSteps)
{
  struct Counter : SiteForces
  {
    const std::vector<SiteForce> &evaluate(State &, Field &, Field &) override
    {
      ++n;
      return forces_;
    }
    unsigned int n = 0;
  } counter;
  const TriangularLattice sheet = sheets::square(30);
  const Material material = sheets::rubber();
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  double fastest = 0.;
  for (const Complex &rate : plane_modes::rates(sheet, material, F))
    fastest = support::largest_of({fastest, std::abs(rate)});
  const double limit = ChebyshevStages(7).real_limit();
  for (const double share : {1., 0.5, 0.25, 0.125, 1.})
  {
    State state = homogeneous_state(sheet, material, F, Edges::held);
    add_noise(state, sheet, 1e-3 * sheets::spacing, 5);
    Forces forces(sheet, material);
    RungeKuttaChebyshev integrator(sheet, forces, limit / fastest, 7);
    integrator.set_time_step(share * limit / fastest);
    integrator.add(counter);
    integrator.initialise(state);
    integrator.step(state);
    const double before = kinetic_energy(state, sheet);
    counter.n = 0;
    for (int step = 0; step < 100; ++step)
      integrator.step(state);
    EXPECT_EQ(counter.n, 100 * (share == 1. ? 7 : ChebyshevStages::needed(share * limit))) << share;
    EXPECT_LT(kinetic_energy(state, sheet), before) << share;
  }
}

// Loads on free ends balance the stretched sheet in each stage, or it would not stay at rest.
TEST(RungeKuttaChebyshev, AppliesForcesOnSitesInEachStage)
{
  const TriangularLattice sheet = sheets::square(10);
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  const Material material = sheets::rubber();
  const State rest = homogeneous_state(sheet, material, F, {false, false, true, true});
  Simulation simulation(sheet, material, rest, {4e-6, 7});
  simulation.load_ends(F, EndLoads::End::free, EndLoads::End::free);
  for (int step = 0; step < 100; ++step)
    simulation.step();
  EXPECT_LT(distance(simulation.state(), rest), 1e-11 * sheets::spacing);
}

TEST(RungeKuttaChebyshev, KeepsTheVelocityOfHeldSites)
{
  const TriangularLattice sheet = sheets::square(10);
  const Material material = sheets::rubber();
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, sheets::stretched(1.2, 1.1), Edges::held),
                        {4e-6, 6});
  const State before = simulation.state();
  const Eigen::Matrix2d L = sheets::stretched(30., 70.);
  simulation.constrain({held_sites(before, sheet), true, true, steady(L)});
  const int steps = 200;
  for (int step = 0; step < steps; ++step)
    simulation.step();
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
    if (before.held[place] != 0 && sheet.is_site(place))
    {
      const Eigen::Vector2d velocity = L * sheet.reference(place);
      EXPECT_EQ(simulation.state().vx[place], velocity.x());
      EXPECT_EQ(simulation.state().vy[place], velocity.y());
      EXPECT_NEAR(simulation.state().x[place], before.x[place] + steps * 4e-6 * velocity.x(), 1e-12 * sheet.length());
    }
}

// Same bits for 1, 2 and 4 threads, through breaking ahead, toughening, contact and the ledger.
TEST(RungeKuttaChebyshev, BitsDoNotDependOnThreads)
{
  const TriangularLattice sheet = sheets::square(70); // more places than are left to one thread
  ASSERT_GE(sheet.n_places(), min_places_for_threads);
  const auto result = [&](int threads)
  {
    omp_set_num_threads(threads);
    auto crack = running_crack::start(sheet, sheets::rubber(), TimeStepping{4e-6, 7}, true);
    std::size_t touching = 0;
    for (int step = 0; step < 250; ++step)
    {
      crack->step();
      touching = std::max(touching, crack->contact()->n_touching());
    }
    EXPECT_GT(touching, 1u);
    return crack;
  };
  const auto one = result(1);
  EXPECT_GT(one->n_broken(), 100u);
  for (const int threads : {2, 4})
    running_crack::expect_same_bits(*result(threads), *one);
}

} // namespace runge_kutta_chebyshev_test
