// Motions with gradient energy, micro-inertia and damage.
#include "continuum/damage/damage_motion.h"
#include "continuum/damage/patch_bound.h"
#include "continuum/errors.h"
#include "damaged_sheets.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

namespace damage_gradient_test
{

using namespace damaged_sheets;

DamageMotionSetup sheet(const Tensor<2, 2> &F, const Rectangle &rectangle, const double step)
{
  DamageMotionSetup setup{
    rectangle, F,   fibres(lattice()), {}, 950., {1e9, spacing}, [](const Point<2> &, unsigned int) { return false; },
    {},        step};
  setup.gradient = GradientSetup{lattice(), 0.5 * spacing};
  return setup;
}

// theory-damage.md, eqs. (C.79) and (C.82).
TEST(DamageMotion, MovesWavesAsTheirDispersionSays)
{
  // One step from rest, in the middle of a sheet that is large enough: the mass operator forgets an edge as
  // exp(-0.9 y/h) or faster.
  constexpr unsigned int n = 50;
  const Tensor<2, 2> F = matrix(2.3, 0., 0., 2.8);
  const double h = 0.5 * spacing, k = 1.2 / spacing, amplitude = 1e-7;
  const double K = std::pow(2. / h * std::sin(0.5 * k * h), 2);
  for (const bool has_micro_inertia : {true, false})
    for (const double d : {0., 0.5})
    {
      const double omega2 =
        stiffness_of_waves(F, 0, 0, K, 0.5 * spacing, has_micro_inertia ? 0.5 * spacing : 0.) / 950.;
      const double step = 0.02 / std::sqrt(omega2);
      DamageMotionSetup setup = sheet(F, {n * h, n * h, n, n}, step);
      setup.gradient->has_micro_inertia = has_micro_inertia;
      DamageMotion motion(setup);
      motion.set_damage([d](const Point<2> &) { return d; });
      motion.set_motion(
        [&](const Point<2> &X) {
          return Tensor<1, 2>({amplitude * std::cos(k * (X[0] - 12.5)), 0.});
        },
        [](const Point<2> &) { return Tensor<1, 2>(); });
      EXPECT_GT(motion.ledger().gradient, 0.);
      motion.advance();
      const std::size_t middle = n / 2 * motion.grid().columns() + n / 2;
      const double moved = motion.displacement()[0][middle] / amplitude - 1.;
      // Non-linear terms and the tolerance of the mass operator: 1e-6 of omega^2.
      EXPECT_NEAR(moved, -0.5 * omega2 * step * step, 1e-6 * omega2 * step * step) << has_micro_inertia << ' ' << d;
    }
}

// Change of the velocity of the lower half within a step, caused by opening the upper half.
double transmitted(const bool is_broken)
{
  GridVector velocity[2];
  for (const bool is_open : {false, true})
  {
    DamageMotion motion(sheet(matrix(2.3, 0., 0., 2.8), {6., 4.5, 12, 9}, 1e-4));
    if (is_broken)
      motion.set_damage([](const Point<2> &X) { return std::abs(X[1]) < 0.26 ? 1. : 0.; });
    const GridVector rough = random_field(motion.grid(), 0.02);
    std::size_t a = 0;
    motion.set_motion(
      [&](const Point<2> &X)
      {
        const std::size_t own = a++;
        return is_open && X[1] > 0. ? Tensor<1, 2>({rough[0][own], 1. + rough[1][own]}) : Tensor<1, 2>();
      },
      [](const Point<2> &) { return Tensor<1, 2>(); });
    motion.advance();
    velocity[is_open ? 1 : 0] = motion.velocity();
  }
  double sum = 0.;
  for (const unsigned int i : {0u, 1u})
    for (std::size_t a = 0; a < 13 * 5; ++a) // the lower five rows of nodes
      sum += std::pow(velocity[1][i][a] - velocity[0][i][a], 2);
  return std::sqrt(sum);
}

TEST(DamageMotion, TransmitsNothingAcrossABrokenLine)
{
  // All that crosses the line has the factor k; the nodes beside it have lost half of their mass.
  EXPECT_GT(transmitted(false), 0.);
  const DamageLaw law{1., 1.};
  EXPECT_LT(transmitted(true), 10. * law.residual_stiffness * transmitted(false));
}

// Energies after `time` of a sheet with a wave and, if `viscosity` > 0, dashpots.
DamageMotionLedger wave_ledger(const double viscosity, const double step, const double time)
{
  DamageMotionSetup setup = sheet(matrix(2.3, 0., 0., 2.8), {5., 4., 10, 8}, step);
  setup.is_held = [](const Point<2> &X, unsigned int)
  { return X[0] < 1e-9 || X[0] > 5. - 1e-9 || std::abs(X[1]) > 2. - 1e-9; };
  setup.dashpots = viscosity > 0. ? dashpots(fibres(lattice()), viscosity) : std::vector<FibreDashpot>();
  DamageMotion motion(setup);
  motion.set_damage([](const Point<2> &X) { return 0.1 * X[0]; });
  motion.set_motion(
    [](const Point<2> &X) {
      return Tensor<1, 2>({0.1 * std::sin(pi * X[0] / 2.5), 0.});
    },
    [](const Point<2> &) { return Tensor<1, 2>(); });
  while (motion.time() < time - 0.5 * step)
    motion.advance();
  return motion.ledger();
}

TEST(DamageMotion, ClosesTheLedgerWithGradientEnergy)
{
  for (const double viscosity : {0., 300.})
  {
    const DamageMotionLedger coarse = wave_ledger(viscosity, 2e-4, 0.02), fine = wave_ledger(viscosity, 1e-4, 0.02);
    EXPECT_GT(fine.kinetic, 0.);
    EXPECT_GT(fine.gradient, 0.);
    // Of second order in the step, or better where that term is small.
    EXPECT_GT(std::log2(std::abs(coarse.imbalance / fine.imbalance)), 1.5) << viscosity;
    EXPECT_LT(std::abs(fine.imbalance), 1e-3 * (fine.kinetic + fine.gradient)) << viscosity;
  }
}

bool is_accepted(const DamageMotionSetup &setup)
{
  try
  {
    DamageMotion{setup};
    return true;
  }
  catch (const InvalidInput &)
  {
    return false;
  }
}

// theory-damage.md, eq. (C.81).
TEST(DamageMotion, IsStableUpToTheStepThatItStates)
{
  // Noise on a sheet without pre-stretch does not grow, whatever its damage; with it, damage would set it in motion.
  for (const bool has_micro_inertia : {true, false})
    for (const auto &[viscosity, is_stretched] :
         {std::pair(0., false), std::pair(0., true), std::pair(3e3, false), std::pair(3e3, true)})
    {
      const Tensor<2, 2> F = is_stretched ? matrix(2.3, 0., 0., 2.8) : matrix(1., 0., 0., 1.);
      DamageMotionSetup setup = sheet(F, {3., 3., 8, 8}, 1e-9);
      setup.gradient->has_micro_inertia = has_micro_inertia;
      setup.step = 0.99 * DamageMotion(setup).stable_step();
      if (viscosity > 0.)
      {
        setup.dashpots = dashpots(fibres(lattice()), viscosity);
        while (!is_accepted(setup))
          setup.step *= 0.98;
      }
      setup.is_held = [](const Point<2> &X, unsigned int)
      { return X[0] < 1e-9 || X[0] > 3. - 1e-9 || std::abs(X[1]) > 1.5 - 1e-9; };
      DamageMotion motion(setup);
      std::mt19937 random(5);
      std::uniform_real_distribution<double> some(0., 1.);
      if (!is_stretched)
        motion.set_damage([&](const Point<2> &) { return some(random); });
      motion.set_motion(
        [&](const Point<2> &) {
          return 1e-8 * some(random) * Tensor<1, 2>({1., -0.7});
        },
        [](const Point<2> &) { return Tensor<1, 2>(); });
      for (unsigned int step = 0; step < 150; ++step)
        motion.advance();
      double sum = 0.;
      for (std::size_t b = 0; b < motion.grid().n_nodes(); ++b)
        sum += std::pow(motion.displacement()[0][b], 2) + std::pow(motion.displacement()[1][b], 2);
      // Far above the noise, far below growth by 1 % a step.
      EXPECT_LT(std::sqrt(sum), 3e-6) << has_micro_inertia << ' ' << viscosity << ' ' << is_stretched;
      setup.step *= 1.03;
      EXPECT_FALSE(is_accepted(setup));
    }
}

TEST(DamageMotion, HasTheSameBitsWithGradientEnergyOnAnyNumberOfThreads)
{
  GridVector u[2];
  const int threads = omp_get_max_threads();
  for (const int n : {0, 1})
  {
    omp_set_num_threads(n + 1);
    DamageMotionSetup setup = sheet(matrix(1.3, 0., 0., 1.5), {36.5, 35., 73, 70}, 1e-3); // large enough for threads
    setup.dashpots = dashpots(fibres(lattice()), 300.);
    DamageMotion motion(setup);
    motion.set_damage([](const Point<2> &X) { return std::abs(X[1]) < 0.6 && X[0] < 10. ? 1. : 0.; });
    for (unsigned int step = 0; step < 2; ++step)
      motion.advance();
    u[n] = motion.displacement();
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(u[0], u[1]);
}

TEST(DamageMotion, RefusesInvalidGradients)
{
  const DamageMotionSetup setup = sheet(matrix(1., 0., 0., 1.), {4., 4., 8, 8}, 1e-5);
  EXPECT_NO_THROW(DamageMotion{setup});
  DamageMotionSetup wrong = setup;
  for (const double length : {0., -1., std::nan("")})
  {
    wrong.gradient->length = length;
    EXPECT_THROW(DamageMotion{wrong}, InvalidInput);
  }
  wrong.gradient->length = 0.49 * spacing; // less than eq. (C.26)
  EXPECT_THROW(DamageMotion{wrong}, InvalidMaterial);
  wrong = setup;
  wrong.gradient->bonds.clear();
  EXPECT_THROW(DamageMotion{wrong}, InvalidMaterial);
}

} // namespace damage_gradient_test
