// Motion of a sheet with damage.
#include "continuum/damage/damage_motion.h"
#include "continuum/errors.h"
#include "damaged_sheets.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

namespace damage_motion_test
{

using namespace damaged_sheets;

// Bar between held ends, in uniaxial strain, whose fundamental mode is excited.
DamageMotion bar(const double viscosity, const double step)
{
  constexpr unsigned int n = 16;
  DamageMotionSetup setup{
    Rectangle{1., 1. / n, n, 1}, matrix(1., 0., 0., 1.), springs(), {}, 1000., {1e9, 0.1}, {}, {}, step};
  if (viscosity > 0.)
    setup.dashpots = dashpots(springs(), viscosity);
  setup.is_held = [](const Point<2> &X, const unsigned int i) { return i == 1 || X[0] < 1e-9 || X[0] > 1. - 1e-9; };
  DamageMotion motion(setup);
  motion.set_motion(
    [](const Point<2> &X) {
      return Tensor<1, 2>({1e-7 * std::sin(pi * X[0]), 0.});
    },
    [](const Point<2> &) { return Tensor<1, 2>(); });
  return motion;
}

// theory-damage.md, eq. (C.69).
TEST(DamageMotion, DoesNotSlowWavesDown)
{
  // Semi-discrete frequency of linear elements with lumped mass, and that of velocity Verlet: exact for this mode. The
  // modulus of uniaxial strain is 9/8 of that of a spring.
  const double h = 1. / 16., dt = 2e-4;
  const double omega = 2. / h * std::sin(0.5 * pi * h) * std::sqrt(9. / 8. * 1e6 / 1000.);
  const double with_steps = 2. / dt * std::asin(0.5 * omega * dt);
  for (const double d : {0., 0.5, 0.99})
  {
    DamageMotion motion = bar(0., dt);
    motion.set_damage([d](const Point<2> &) { return d; });
    const double all = motion.ledger().elastic;
    for (unsigned int n = 0; n < 60; ++n)
      motion.advance();
    // Non-linear terms: the strain 3e-7, over two radians.
    EXPECT_NEAR(motion.displacement()[0][8] / 1e-7, std::cos(with_steps * motion.time()), 2e-6) << d;
    // Velocity Verlet conserves m v^2 / 2 + m omega^2 u^2 (1 - (omega dt)^2 / 4) / 2.
    EXPECT_LT(std::abs(motion.ledger().imbalance), 0.25 * std::pow(omega * dt, 2) * all) << d;
  }
}

// theory-damage.md, eqs. (C.71) and (C.73).
TEST(DamageMotion, DampsWavesOfDamagedMaterialAsThoseOfIntactOnes)
{
  const double h = 1. / 16., viscosity = 3000.;
  const double k = 2. / h * std::sin(0.5 * pi * h);
  const double omega = k * std::sqrt(9. / 8. * 1e6 / 1000.);
  const double g = 0.5 * k * k * 9. / 8. * viscosity / 1000.; // eq. (C.48)
  const double own = std::sqrt(omega * omega - g * g);
  for (const unsigned int i : {0u, 1u})
  {
    const double dt = i == 0 ? 4e-4 : 2e-4;
    DamageMotion motion = bar(viscosity, dt);
    EXPECT_GT(motion.n_stages(), 1u);
    motion.set_damage([](const Point<2> &) { return 0.5; });
    const double all = motion.ledger().elastic;
    while (motion.time() < 0.012 - 0.5 * dt)
      motion.advance();
    const double t = motion.time();
    const double error = std::abs(motion.displacement()[0][8] / 1e-7 -
                                  std::exp(-g * t) * (std::cos(own * t) + g / own * std::sin(own * t)));
    // The mode is the real part of an exponential, of which each step multiplies by R(lambda dt). Non-linear terms.
    const std::complex<double> R =
      amplification(ViscousStages(motion.n_stages()), std::complex<double>(-g * dt, own * dt));
    const std::complex<double> expected = std::complex<double>(1., -g / own) * std::pow(R, motion.n_steps());
    EXPECT_NEAR(motion.displacement()[0][8] / 1e-7, expected.real(), 2e-6);
    // A method of second order: (omega dt)^2 for each radian, with a constant below 1.
    EXPECT_LT(error, std::pow(omega * dt, 2) * omega * t) << dt;
    EXPECT_LT(std::abs(motion.ledger().imbalance), 2. * std::pow(omega * dt, 2) * omega * t * all) << dt;
    EXPECT_GT(motion.ledger().viscous, 0.1 * all);
  }
}

// Strip with a slit, stretched so that the crack runs.
DamageMotion strip(const unsigned int refinement = 1)
{
  DamageMotionSetup setup{Rectangle{0.02, 0.0105, 40 * refinement, 21 * refinement},
                          matrix(1., 0., 0., 1.02),
                          springs(),
                          dashpots(springs(), 10.),
                          1000.,
                          {295., 1e-3},
                          {},
                          {},
                          2e-6};
  setup.is_held = [](const Point<2> &X, unsigned int) { return std::abs(X[1]) > 0.00524; };
  setup.is_intact = [](const Point<2> &X) { return std::abs(X[1]) > 0.004; };
  return DamageMotion(setup);
}

// theory-damage.md, eq. (C.74).
TEST(DamageMotion, RunsACrackWithTheSameBitsOnAnyNumberOfThreads)
{
  std::vector<double> damage[2];
  const int threads = omp_get_max_threads();
  for (const int n : {0, 1})
  {
    omp_set_num_threads(n + 1);
    DamageMotion motion = strip(3); // large enough for threads
    motion.set_damage(
      [](const Point<2> &X)
      {
        const double depth = 1. - std::hypot(std::max(0., X[0] - 0.006), std::max(0., std::abs(X[1]) - 3e-4)) / 2e-3;
        return depth > 0. ? depth * depth : 0.;
      });
    const double before = motion.ledger().elastic;
    for (unsigned int step = 0; step < 30; ++step)
      motion.advance();
    EXPECT_GT(motion.ledger().fracture, 0.);
    EXPECT_LT(motion.ledger().elastic, before);
    EXPECT_LT(std::abs(motion.ledger().imbalance), 0.02 * before);
    damage[n] = motion.damage().nodal();
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(damage[0], damage[1]);
}

// The loading drives the damage of a seed further, which loses energy in a jump.
TEST(DamageMotion, SettlesTheDamageOfASeedBeforeItsLedger)
{
  const auto remainder = [](const bool settles)
  {
    DamageMotion motion = strip();
    motion.set_damage(
      [](const Point<2> &X)
      {
        const double depth = 1. - std::hypot(std::max(0., X[0] - 0.006), std::max(0., std::abs(X[1]) - 3e-4)) / 2e-3;
        return depth > 0. ? depth * depth : 0.;
      });
    if (settles)
    {
      const std::vector<double> initial = motion.damage().nodal();
      motion.settle_damage();
      const std::vector<double> settled = motion.damage().nodal();
      EXPECT_NE(settled, initial);
      EXPECT_EQ(motion.ledger().fracture, 0.);
      EXPECT_EQ(motion.ledger().imbalance, 0.);
      motion.settle_damage();
      EXPECT_EQ(motion.damage().nodal(), settled);
    }
    for (unsigned int step = 0; step < 10; ++step)
      motion.advance();
    return std::abs(motion.ledger().imbalance);
  };
  EXPECT_LT(remainder(true), 0.2 * remainder(false));
}

TEST(DamageMotion, DoesNotBreakWithoutASeed)
{
  DamageMotion motion = strip();
  for (unsigned int step = 0; step < 20; ++step)
    motion.advance();
  EXPECT_EQ(motion.ledger().fracture, 0.);
  for (const double d : motion.damage().nodal())
    EXPECT_EQ(d, 0.);
}

// A sheet at large strain with a slit, whose threshold is out of reach: behind the slit it relaxes across, where rods
// are several times as stiff as at F_0. The longest step that the constructor states stays stable there: what the slit
// releases is all that moves. theory-damage.md, eq. (C.72).
TEST(DamageMotion, IsStableWhereItRelaxes)
{
  for (const double viscosity : {0., 5.})
  {
    DamageMotionSetup setup{
      Rectangle{0.04, 0.0201, 80, 41}, matrix(2.3, 0., 0., 2.8), rods(), {}, 944., {4e7, 1e-3}, {}, {}, 1e-9};
    if (viscosity > 0.)
      setup.dashpots = dashpots(springs(), viscosity);
    setup.is_held = [](const Point<2> &X, unsigned int) { return std::abs(X[1]) > 0.01004; };
    setup.step = 0.5 * DamageMotion(setup).stable_step();
    DamageMotion motion(setup);
    motion.set_damage(
      [](const Point<2> &X)
      {
        const double depth = 1. - std::hypot(std::max(0., X[0] - 0.02), std::max(0., std::abs(X[1]) - 3e-4)) / 2e-3;
        return depth > 0. ? depth * depth : 0.;
      });
    const double before = motion.ledger().elastic;
    while (motion.time() < 5e-5)
    {
      ASSERT_NO_THROW(motion.advance()) << "viscosity " << viscosity << " Pa s, time " << motion.time() << " s";
      ASSERT_LE(motion.ledger().kinetic, before - motion.ledger().elastic + 1e-3 * before);
    }
    EXPECT_LT(std::abs(motion.ledger().imbalance), 1e-3 * before);
  }
}

TEST(DamageMotion, HasTheStateBeforeAStepThatFails)
{
  DamageMotion motion = strip();
  motion.set_motion([](const Point<2> &) { return Tensor<1, 2>(); },
                    [](const Point<2> &X)
                    {
                      return Tensor<1, 2>({0., 3e3 * std::sin(2e3 * X[0])}); // inverts cells
                    });
  GridVector u, v;
  std::vector<double> damage, energies;
  double imbalance = 0.;
  bool has_failed = false;
  for (unsigned int step = 0; step < 100 && !has_failed; ++step)
  {
    u = motion.displacement();
    v = motion.velocity();
    damage = motion.damage().nodal();
    energies = motion.cell_energies();
    imbalance = motion.ledger().imbalance;
    const std::size_t n = motion.n_steps();
    try
    {
      motion.advance();
    }
    catch (const NonPhysicalState &)
    {
      has_failed = true;
      EXPECT_EQ(motion.n_steps(), n);
    }
  }
  ASSERT_TRUE(has_failed);
  EXPECT_EQ(motion.displacement(), u);
  EXPECT_EQ(motion.velocity(), v);
  EXPECT_EQ(motion.damage().nodal(), damage);
  EXPECT_EQ(motion.cell_energies(), energies);
  EXPECT_EQ(motion.ledger().imbalance, imbalance);
}

TEST(DamageMotion, RefusesInvalidInput)
{
  DamageMotionSetup setup{Rectangle{1., 1., 4, 4},
                          matrix(1., 0., 0., 1.),
                          springs(),
                          {},
                          1000.,
                          {1e3, 0.5},
                          [](const Point<2> &, unsigned int) { return false; },
                          {},
                          1e-4};
  EXPECT_NO_THROW(DamageMotion{setup});
  DamageMotionSetup wrong = setup;
  wrong.density = -1.;
  EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  wrong = setup;
  wrong.step = std::nan("");
  EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  wrong = setup;
  wrong.step = 1.; // unstable without viscosity
  EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  wrong = setup;
  wrong.rectangle.periodic_x = true;
  EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  wrong = setup;
  wrong.families.clear();
  EXPECT_THROW(DamageMotion{wrong}, InvalidMaterial);
  wrong = setup;
  wrong.is_held = nullptr;
  EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
}

} // namespace damage_motion_test
