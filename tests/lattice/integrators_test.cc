// Both integrators follow smooth motions of a sheet to second order, with dashpots and memories, and so do their
// ledgers.
#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "lattice/integrator.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/sheets.h"

namespace integrators_test
{

using namespace latcon;
using namespace lattice;

struct Motion
{
  const char *name;
  Material material;
  unsigned int stages; // 0: velocity Verlet
  double step;         // [s]
  std::size_t steps;
};

std::ostream &operator<<(std::ostream &out, const Motion &motion)
{
  return out << motion.name << ", " << motion.stages << " stages";
}

class Integrators : public testing::TestWithParam<Motion>
{
protected:
  struct End
  {
    State state;
    double imbalance; // of the ledger [J/m]
  };

  // After steps of a fraction of those of the motion: a stretched sheet with edges that move, set off by a smooth
  // velocity field.
  static End run(unsigned int stages, std::size_t refinement)
  {
    const Material &material = GetParam().material;
    const TriangularLattice sheet = sheets::square(12);
    Simulation simulation(sheet, material, homogeneous_state(sheet, material, sheets::stretched(1.5, 1.4), Edges::held),
                          {GetParam().step / static_cast<double>(refinement), stages});
    VectorField velocity(sheet.n_places());
    for (std::size_t i = 0; i < sheet.n_places(); ++i)
    {
      const Eigen::Vector2d X = sheet.reference(i) / sheets::spacing;
      velocity.set(i, {4. * std::sin(0.5 * X.x()) * std::cos(0.4 * X.y()), 3. * std::cos(0.3 * X.x() + 0.5 * X.y())});
    }
    simulation.set_velocities(velocity);
    simulation.constrain({held_sites(simulation.state(), sheet), true, true, steady(sheets::stretched(400., 200.))});
    for (std::size_t step = 0; step < refinement * GetParam().steps; ++step)
      simulation.step();
    return {simulation.state(), simulation.energies().imbalance()};
  }

  // Positions at which two results of second order point.
  static Eigen::VectorXd limit(const State &coarse, const State &fine)
  {
    return positions(fine) + (positions(fine) - positions(coarse)) / 3.;
  }
  static Eigen::VectorXd positions(const State &state)
  {
    Eigen::VectorXd all(2 * state.position.x.size());
    all << Eigen::Map<const Eigen::VectorXd>(state.position.x.data(), state.position.x.size()),
      Eigen::Map<const Eigen::VectorXd>(state.position.y.data(), state.position.y.size());
    return all;
  }
};

// Velocity Verlet with strong dashpots: a quarter of the stable step, where the stiffest modes have come into the
// asymptotic range.
const double damped_step = 0.25 * time_step_limits(sheets::square(12), sheets::rubber(), 0.5).viscous;
INSTANTIATE_TEST_SUITE_P(Motions, Integrators,
                         testing::Values(Motion{"springs", sheets::rubber(0.), 0, 4e-7, 200},
                                         Motion{"strong dashpots", sheets::rubber(), 0, damped_step, 400},
                                         Motion{"branches", sheets::rubber_with_memory(5.), 0, 1e-7, 400},
                                         Motion{"springs", sheets::rubber(0.), 3, 5e-7, 160},
                                         Motion{"dashpots", sheets::rubber(2.), 3, 5e-7, 160},
                                         Motion{"dashpots", sheets::rubber(2.), 8, 5e-7, 160},
                                         Motion{"branches", sheets::rubber_with_memory(5.), 6, 2e-7, 200}));

// theory.md, eq. (L.7).
TEST_P(Integrators, ConvergeAtSecondOrderToOneMotion)
{
  const unsigned int stages = GetParam().stages;
  const End coarse = run(stages, 1), medium = run(stages, 2), fine = run(stages, 4);
  const double difference = (positions(medium.state) - positions(fine.state)).norm();
  EXPECT_NEAR(std::log2((positions(coarse.state) - positions(medium.state)).norm() / difference), 2., 0.15);
  const double order_of_ledger = std::log2(std::abs(medium.imbalance / fine.imbalance));
  if (stages > 0 && GetParam().material.nearest.viscosity == 0.) // without what dashpots take it is of higher order
    EXPECT_GT(order_of_ledger, 1.8);
  else
    EXPECT_NEAR(order_of_ledger, 2., 0.2);
  if (stages > 0)
  {
    const Eigen::VectorXd of_verlet = limit(run(0, 4).state, run(0, 8).state);
    EXPECT_LT((limit(medium.state, fine.state) - of_verlet).norm(), 0.1 * difference);
  }
}

// An integrator that no file of the library names: v' = v + h a, x' = x + h v'.
struct SemiImplicitEuler : Integrator
{
  using Integrator::Integrator;
  void step(State &state) override
  {
    for (const std::size_t place : band_.known_sites())
    {
      if (state.inverse_mass[place] > 0.)
        state.velocity.add(place, time_step() * state.acceleration.at(place));
      state.position.add(place, time_step() * state.velocity.at(place));
    }
    exchange_ghosts(state);
    forces_.set_elapsed(time_step());
    accelerate(state);
    state.time += time_step();
  }
};

TEST(OwnIntegrator, ConvergesAtItsOrderToTheMotionOfTheOthers)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber_with_memory(0.);
  const auto end = [&](std::size_t steps, bool is_own)
  {
    TimeStepping stepping(8e-5 / static_cast<double>(steps));
    if (is_own)
      stepping.make = [&](const RowPartition &band, Forces &forces)
      { return std::make_unique<SemiImplicitEuler>(band, forces, stepping.step); };
    State state = homogeneous_state(sheet, material, sheets::stretched(1.5, 1.4), Edges::held);
    state.position.x[sheet.index(5, 5)] += 0.1 * sheets::spacing;
    Simulation simulation(sheet, material, state, stepping);
    for (std::size_t step = 0; step < steps; ++step)
      simulation.step();
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(simulation.state().position.x.data(), sheet.n_places()));
  };
  const Eigen::VectorXd exact = end(1600, false);
  const double coarse = (end(400, true) - exact).norm(), fine = (end(800, true) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 1., 0.1);
}

// Loads on free ends balance the stretched sheet in each stage, or it would not stay at rest.
TEST(RungeKuttaChebyshev, AppliesForcesOnSitesInEachStage)
{
  const TriangularLattice sheet = sheets::square(10);
  const Eigen::Matrix2d F = sheets::stretched(2.3, 2.8);
  const Material material = sheets::rubber();
  Simulation simulation(sheet, material, homogeneous_state(sheet, material, F, {false, false, true, true}), {4e-6, 7});
  simulation.load_ends(F, EndLoads::End::free, EndLoads::End::free);
  for (int step = 0; step < 100; ++step)
    simulation.step();
  for (const std::size_t place : sheet.sites())
  {
    EXPECT_LT((simulation.position(place) - F * sheet.reference(place)).norm(), 1e-12 * sheets::spacing);
  }
}

// One bond's dashpot between two free sites: v_rel' = -2 (c/m) v_rel exactly, so the scheme's own recursion is known:
// its two roots for z = gamma h solve r^2 - (1 - 3z/2) r - z/2 = 0, and it diverges beyond z = 1.
// theory.md, eq. (L.8).
TEST(VelocityVerlet, DampingLimitOfOneDashpotIsOne)
{
  const TriangularLattice sheet = sheets::square(6);
  Material material = sheets::nearest_only();
  material.nearest.law = LinearBond{1e-9}; // springs out of the way
  const double mass = site_mass(material, sheet);
  const double gamma =
    2. * cross_section(material.nearest, sheet) * material.nearest.viscosity / (sheets::spacing * mass);
  const auto relative_velocity_after = [&](double z, int steps)
  {
    State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::free);
    const std::size_t left = sheet.index(3, 2);
    state.bonds.clear(sheet.n_places());
    state.bonds.add(left, 0);
    state.velocity.x[left] = -1e-6;
    state.velocity.x[left + 1] = 1e-6;
    Forces forces(sheet, material);
    VelocityVerlet verlet(sheet, forces, z / gamma);
    verlet.initialise(state);
    for (int step = 0; step < steps; ++step)
      verlet.step(state);
    return std::abs(state.velocity.x[left + 1] - state.velocity.x[left]) / 2e-6;
  };
  EXPECT_LT(relative_velocity_after(0.99, 2000), 1.);
  EXPECT_GT(relative_velocity_after(1.01, 2000), 1.);
  // z = 1/2: largest root (1/4 + sqrt(1/16 + 1)) / 2.
  const double root = (0.25 + std::sqrt(1.0625)) / 2.;
  EXPECT_NEAR(relative_velocity_after(0.5, 21) / relative_velocity_after(0.5, 20), root, 1e-4);
}

TEST(Noise, DependsOnSeedAloneAndKeepsItsAmplitude)
{
  const TriangularLattice sheet = sheets::square(30);
  const Material material = sheets::rubber();
  const State still = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), Edges::held);
  State a = still, b = still, c = still;
  add_noise(a, sheet, 1e-5, 7);
  add_noise(b, sheet, 1e-5, 7);
  add_noise(c, sheet, 1e-5, 8);
  EXPECT_EQ(a.position.x, b.position.x);
  EXPECT_NE(a.position.x, c.position.x);
  double largest = 0., sum = 0., square = 0.;
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.position.x.size(); ++i)
    if (still.inverse_mass[i] > 0.)
      for (const double u : {a.position.x[i] - still.position.x[i], a.position.y[i] - still.position.y[i]})
      {
        largest = support::largest_of({largest, std::abs(u)});
        sum += u;
        square += u * u;
        ++n;
      }
    else
      EXPECT_EQ(a.position.x[i], still.position.x[i]);
  // Uniform on [-A, A]: mean 0 +- A / sqrt(3n), mean square A^2 / 3; three standard deviations.
  EXPECT_LE(largest, 1e-5 * (1. + 1e-9));
  EXPECT_NEAR(sum / n, 0., 3. * 1e-5 / std::sqrt(3. * n));
  EXPECT_NEAR(square / n / 1e-10, 1. / 3., 3. * std::sqrt(4. / 45. / n));
}

} // namespace integrators_test
