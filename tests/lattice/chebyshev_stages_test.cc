#include "lattice/chebyshev_stages.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/contact.h"
#include "lattice/integrator.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "tests/lattice/plane_modes.h"

namespace chebyshev_stages_test
{

using namespace latcon;

using namespace lattice;
using Complex = std::complex<double>;

constexpr unsigned int most_stages = 60;
// A stage adds a few roundings, and the differences that the recursion is made of grow as its number.
constexpr double roundoff = 1e-13 * most_stages;

// theory.md, eqs. (L.17) to (L.19).
TEST(ChebyshevStages, AreOfSecondOrder)
{
  for (unsigned int s = 2; s <= most_stages; ++s)
  {
    const ChebyshevStages stages(s);
    EXPECT_EQ(stages.stages().size() + 1, s);
    // The first term left over is between (1/6 - 1/8) z^3, that of many stages, and z^3 / 6, that of two.
    for (const Complex z : {Complex(-1e-3, 0.), Complex(0., 1e-3), Complex(-6e-4, 8e-4)})
    {
      const double error = std::abs(stages.amplification(z) - std::exp(z)) / std::pow(std::abs(z), 3);
      EXPECT_GT(error, 1. / 24.) << s;
      EXPECT_LT(error, 1. / 6. + 1e-3) << s;
    }
  }
}

// theory.md, eqs. (L.20) and (L.22): real rates up to the limit; oscillating ones in the disc of radius 1 that touches
// 0, by its rim, on which |R| is largest.
TEST(ChebyshevStages, AreStableForDampedModes)
{
  for (unsigned int s = 2; s <= most_stages; ++s)
  {
    const ChebyshevStages stages(s);
    const int n = 2000;
    for (int i = 0; i <= n; ++i)
    {
      const double real = -stages.real_limit() * i / n;
      EXPECT_LE(std::abs(stages.amplification(real)), 1. + roundoff) << s << ' ' << real;
      const Complex z = std::polar(1., M_PI * i / n) - 1.;
      EXPECT_LE(std::abs(stages.amplification(z)), 1. + roundoff) << s << ' ' << z;
    }
    EXPECT_GT(std::abs(stages.amplification(-2. * stages.real_limit())), 1.) << s;
    EXPECT_GT(stages.real_limit(), 0.39 * s * s) << s;
  }
}

TEST(ChebyshevStages, AreAsFewAsAreNeeded)
{
  EXPECT_EQ(ChebyshevStages::needed(0.1), 2u);
  for (const double limit : {2., 10., 77., 500.})
  {
    const unsigned int s = ChebyshevStages::needed(limit);
    EXPECT_GE(ChebyshevStages(s).real_limit(), limit);
    EXPECT_LT(ChebyshevStages(s - 1).real_limit(), limit);
  }
  EXPECT_THROW(ChebyshevStages(1), std::invalid_argument);
}

// All plane waves of the lattice, undeformed and as in Fig. 1, with the step that is chosen without being told: none
// grows, and the fastest damped ones are within the bound that the number of stages is chosen for, and not far.
TEST(ChebyshevStages, HoldAllWavesOfTheLattice)
{
  const TriangularLattice sheet = sheets::square(12);
  for (const Material &material : {sheets::rubber(), sheets::nearest_only(), sheets::rubber(20.)})
    for (const Eigen::Matrix2d &F : {sheets::stretched(1., 1.), sheets::stretched(2.3, 2.8)})
    {
      const TimeStepLimits limits = time_step_limits(sheet, material, 0.3);
      const TimeStepping stepping = chebyshev_time_stepping(chebyshev_step(sheet, material, 0.45), limits, 0);
      const ChebyshevStages stages(stepping.stages);
      EXPECT_GE(stages.real_limit(), stepping.step / limits.viscous);
      double fastest = 0.;
      for (const Complex &rate : plane_modes::rates(sheet, material, F))
      {
        EXPECT_LE(std::abs(stages.amplification(stepping.step * rate)), 1. + roundoff) << stepping.step * rate;
        fastest = support::largest_of({fastest, std::abs(rate)});
      }
      EXPECT_LT(fastest * limits.viscous, 1.);
      EXPECT_GT(fastest * limits.viscous, 0.4);
    }
}

// The automatic step with contacts from far softer to far stiffer than bonds, and far less to far more viscous: what
// two free sites that touch do, six around one, and a lattice of nothing but contacts.
// theory.md, eqs. (L.23) and (L.25).
TEST(ChebyshevStages, AreStableWithContactsOfAnyStiffnessAndViscosity)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber();
  const double mass = site_mass(material, sheet), bonds_alone = chebyshev_step(sheet, material, 0.45);
  for (int i = -2; i <= 6; ++i)
    for (int j = -3; j <= 3; ++j)
    {
      const ContactLaw contact =
        contact_like_nearest_bond(sheet, material, sheets::spacing, std::pow(10., i), std::pow(10., j));
      const TimeStepLimits limits = time_step_limits(sheet, material, 0.3, contact);
      const TimeStepping stepping = chebyshev_time_stepping(chebyshev_step(sheet, material, 0.45, contact), limits, 0);
      const ChebyshevStages stages(stepping.stages);
      EXPECT_LE(stepping.step, bonds_alone);
      EXPECT_GE(stages.real_limit(), stepping.step / limits.viscous);
      for (const double contacts : {2., 3., 6.}) // a pair, a site between two others, a site among six
      {
        const double gamma = contacts * contact.viscosity / mass, square = contacts * contact.stiffness / mass;
        const Complex root = std::sqrt(Complex(0.25 * gamma * gamma - square));
        for (const Complex &rate : {-0.5 * gamma + root, -0.5 * gamma - root})
          EXPECT_LE(std::abs(stages.amplification(stepping.step * rate)), 1. + roundoff) << i << ' ' << j;
      }
      EXPECT_FALSE(amplifies_contact(stepping, sheet, material, contact)) << i << ' ' << j;
      EXPECT_LE(stepping.step * std::sqrt(6. * contact.stiffness / mass), 0.7 * (1. + 1e-12)) << i; // resolved
      // Bonds with the spring and the dashpot of a contact.
      Material touching = sheets::nearest_only();
      touching.nearest.law = LinearBond(contact.stiffness * sheets::spacing / cross_section(touching.nearest, sheet));
      touching.nearest.viscosity = contact.viscosity * sheets::spacing / cross_section(touching.nearest, sheet);
      for (const Complex &rate : plane_modes::rates(sheet, touching, sheets::stretched(1., 1.), 12))
        EXPECT_LE(std::abs(stages.amplification(stepping.step * rate)), 1. + roundoff) << i << ' ' << j;
    }
}

// A step for the bonds alone amplifies the oscillation of two sites in stiff contact.
TEST(ChebyshevStages, WouldAmplifyStiffContactsInTheStepOfTheBonds)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber();
  const auto contact = [&](double stiffness, double viscosity)
  { return contact_like_nearest_bond(sheet, material, sheets::spacing, stiffness, viscosity); };
  const TimeStepLimits limits = time_step_limits(sheet, material, 0.3, contact(1000., 1.));
  const TimeStepping of_bonds = chebyshev_time_stepping(chebyshev_step(sheet, material, 0.45), limits, 0);
  EXPECT_TRUE(amplifies_contact(of_bonds, sheet, material, contact(1000., 1.)));
  EXPECT_FALSE(amplifies_contact(of_bonds, sheet, material, contact(1., 1.)));
  // Like bonds, contacts leave the step of the bonds alone.
  EXPECT_EQ(chebyshev_step(sheet, material, 0.45, contact(1., 1.)), chebyshev_step(sheet, material, 0.45));
  // The jump of a very viscous one is resolved.
  const double jump = site_mass(material, sheet) / contact(1., 100.).viscosity;
  EXPECT_EQ(chebyshev_step(sheet, material, 0.45, contact(1., 100.)), jump);
  // Without dashpots every step does.
  EXPECT_EQ(chebyshev_step(sheet, material, 0.45, contact(1., 0.)), 0.);
  EXPECT_TRUE(amplifies_contact({1e-6, 3}, sheet, material, contact(1., 0.)));
  // Velocity Verlet: 2 / omega.
  const ContactLaw elastic = contact(1., 0.);
  const double limit = 2. / std::sqrt(2. * elastic.stiffness / site_mass(material, sheet));
  EXPECT_FALSE(amplifies_contact(0.999 * limit, sheet, material, elastic));
  EXPECT_TRUE(amplifies_contact(1.001 * limit, sheet, material, elastic));
}

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
        state.position.x[place] += wave(place, 0, 1.);
        state.position.y[place] += wave(place, 1, 1.);
        state.velocity.x[place] += wave(place, 2, 1.);
        state.velocity.y[place] += wave(place, 3, 1.);
      }
    Simulation simulation(sheet, material, std::move(state), {h, n_stages});
    for (unsigned int step = 0; step < steps; ++step)
      simulation.step();
    // Quadratic terms are 1e-7 of the wave, rounding of positions of 10 d is 1e-15 over 1e-7, each times some tens.
    const double tolerance = 1e-5 * amplitude * waves.modes.col(mode).tail<2>().norm();
    for (const std::size_t place : sheet.sites())
    {
      EXPECT_NEAR(simulation.state().velocity.x[place], wave(place, 2, factor), tolerance) << mode;
      EXPECT_NEAR(simulation.state().velocity.y[place], wave(place, 3, factor), tolerance) << mode;
    }
  }
}

// Shorter steps take as few stages as the same limit requires, and damp the same noise.
TEST(RungeKuttaChebyshev, TakesFewerStagesInShorterSteps)
{
  struct Counter : SiteForces
  {
    const std::vector<SiteForce> &evaluate(State &, VectorField &) override
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

} // namespace chebyshev_stages_test
