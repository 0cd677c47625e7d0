#include "verification/output/energy_ledger.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace energy_ledger_test
{

using latcon::output::LedgerCheck;
using latcon::output::LedgerState;

LedgerState state(double time, double kinetic, double imbalance)
{
  return {time, 1000. - kinetic, kinetic, 0., 0., 0., imbalance};
}

// theory.md, eq. (L.38): an oscillation between elastic and kinetic energy with the angular frequency omega.
TEST(LedgerCheck, OscillationIsMeasuredByTheEnergyThatItConverts)
{
  const double energy = 3., omega = 200., step = 1e-4;
  LedgerCheck check;
  for (int n = 0; n <= 400; ++n)
    check.add(state(n * step, energy * std::pow(std::sin(omega * n * step), 2), n == 70 ? -6e-3 : 0.));
  EXPECT_NEAR(check.exchanged(), energy, 1e-3 * energy);
  EXPECT_NEAR(check.imbalance(0.), 2e-3, 1e-5);
  EXPECT_NEAR(check.rate(), omega, 1e-3 * omega);
}

// A sheet whose edge is released converts energy at a constant rate from the first step on: the change of power shows.
TEST(LedgerCheck, SurgeIsAsFastAsAnOscillation)
{
  const double power = 5., step = 1e-3;
  for (const double kinetic : {0., 1e-9}) // at rest, and with an unknown power at the start
  {
    LedgerCheck check;
    for (int n = 0; n <= 10; ++n)
      check.add(state(n * step, kinetic + power * n * step, 0.));
    EXPECT_NEAR(check.rate(), kinetic == 0. ? std::sqrt(0.5 / (10. * step * step)) : 1. / (10. * step), 1e-6 / step);
  }
}

// The energies of the sheet and of its waves do not matter, nor does that of the seed.
TEST(LedgerCheck, CrackIsMeasuredByTheEnergyThatItSpends)
{
  LedgerCheck check;
  check.add({0., 1000., 0., 0., 70., 0., 0.});
  check.add({1e-3, 900., 40., 5., 80., 30., 0.2});
  check.add({2e-3, 850., 60., 10., 95., 60., 0.1});
  EXPECT_DOUBLE_EQ(check.exchanged(), 10. + 25.);
  EXPECT_DOUBLE_EQ(check.imbalance(0.), 0.2 / 35.);
}

TEST(LedgerCheck, SheetWhoseCrackDoesNotRunIsMeasuredAsOneWithout)
{
  LedgerCheck check;
  check.add({0., 1000., 1., 0., 70., 0., 0.});
  check.add({1e-3, 990., 5., 4., 70., -3., -0.05});
  EXPECT_DOUBLE_EQ(check.exchanged(), 4. + 3. + 4.);
  EXPECT_DOUBLE_EQ(check.imbalance(0.), 0.05 / 11.);
}

TEST(LedgerCheck, SheetAtRestBalances)
{
  LedgerCheck check;
  check.add(state(0., 0., 0.));
  check.add(state(1., 1e-24, -2e-13));
  EXPECT_EQ(check.imbalance(0.), 0.);
}

TEST(LedgerCheck, EnergyThatIsNotANumberIsNotForgotten)
{
  EXPECT_TRUE(std::isnan(LedgerCheck().imbalance(0.)));
  LedgerCheck check;
  check.add(state(0., 0., 0.));
  check.add(state(1., 1., std::numeric_limits<double>::quiet_NaN()));
  check.add(state(2., 1., 1.));
  EXPECT_TRUE(std::isnan(check.imbalance(0.)));
}

// theory.md, eq. (L.39)
TEST(AllowedImbalance, OfAnImplicitMotionIsOfSecondOrderUpToACeiling)
{
  using latcon::output::allowed_imbalance_of_implicit_motion;
  EXPECT_DOUBLE_EQ(
    *allowed_imbalance_of_implicit_motion(1000., 2e-5) / *allowed_imbalance_of_implicit_motion(1000., 1e-5), 4.);
  EXPECT_EQ(*allowed_imbalance_of_implicit_motion(1000., 1e-2), 1e-2);
  EXPECT_GT(*allowed_imbalance_of_implicit_motion(0., 1e-5), 0.);
}

TEST(AllowedImbalance, OfAMotionOfFewStepsIsThatOfItsStart)
{
  using Integrator = latcon::input::Case::Integrator;
  for (const double lost : {2., 4.})
    for (const Integrator integrator : {Integrator::velocity_verlet, Integrator::runge_kutta_chebyshev})
    {
      const auto allowed = [&](double n) { return latcon::output::allowed_imbalance(integrator, n, lost); };
      EXPECT_DOUBLE_EQ(*allowed(5.), 10. * *allowed(50.));
      EXPECT_EQ(*allowed(1e4), *allowed(1e5));
      EXPECT_TRUE(std::isnan(*allowed(std::numeric_limits<double>::quiet_NaN())));
      EXPECT_FALSE(allowed(5.).reason.empty());
    }
}

} // namespace energy_ledger_test
