// The exact solution of a steady crack in a linear lattice, and the simulator against it.
#include "verification/claims/steady_crack/steady_crack_claim.h"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/verification/claims/faults.h"
#include "verification/claims/order_fit.h"

namespace steady_crack_test
{

using namespace latcon;

using namespace claims;
using namespace output;

// A uniform strip pulled open: springs of one gap in series with those of 2 N more. Its energy for one bond is then
// (1 + L(0)) / 2 of the elongation squared, which gives Griffith's threshold.
// theory-comparison.md, eqs. (S.1), (S.3) and (S.4).
TEST(HalfStrip, IsAStackOfLayersInStatics)
{
  for (const std::size_t free_rows : {1u, 2u, 9u})
  {
    const HalfStrip half({free_rows, 0.5}, 0.3);
    EXPECT_NEAR(half.compliance(0.).real(), 2. * static_cast<double>(free_rows), 1e-11);
    EXPECT_EQ(half.compliance(0.).imag(), 0.);
  }
}

// Bonds pulled at one end: at high frequency only the mass of the sites at the crack resists,
// L = -(2 + cos(q / 2)) / omega^2, q = omega / v.
// theory-comparison.md, eq. (S.4).
TEST(HalfStrip, IsAMassAtHighFrequency)
{
  const double speed = 0.3;
  const HalfStrip half({3, 0.01}, speed);
  for (const double omega : {800., 801., 803.})
  {
    const HalfStrip::Complex expected = -(2. + std::cos(0.5 * omega / speed)) / (omega * omega);
    EXPECT_LT(std::abs(half.compliance(omega) - expected), 0.02 * std::abs(expected));
  }
}

TEST(HalfStrip, RefusesValuesOutOfRange)
{
  EXPECT_THROW(HalfStrip({0, 0.5}, 0.3), std::invalid_argument);
  EXPECT_THROW(HalfStrip({1, 0.}, 0.3), std::invalid_argument);
  EXPECT_THROW(HalfStrip({1, 0.5}, 0.), std::invalid_argument);
}

// One row on each side, a patch so long that its ends do not count: removing a bond releases the energy of the strip,
// so that the two ends of the window are inverse to each other.
// theory-comparison.md, eq. (S.10).
TEST(TrappingWindow, EndsAreInverseToEachOther)
{
  for (const std::size_t free_rows : {1u, 2u, 4u})
  {
    const CrackStrip strip{free_rows, 1.};
    const TrappingWindow coarse = trapping_window(strip, 16 * strip.layers()),
                         window = trapping_window(strip, 24 * strip.layers());
    EXPECT_GT(window.starts, 1.4);
    EXPECT_NEAR(window.starts * window.heals, 1., 4. * std::abs(window.starts - coarse.starts) + 1e-10);
  }
}

// A crack that creeps breaks each bond at rest: the driving of the dynamic solution is that of the static one, which is
// computed in another way.
// theory-comparison.md, eq. (S.8).
TEST(SteadyCrack, CreepsAtTheUpperEndOfTheTrappingWindow)
{
  for (const std::size_t free_rows : {1u, 2u})
  {
    const CrackStrip strip{free_rows, 3.};
    const TrappingWindow coarse = trapping_window(strip, 16 * strip.layers()),
                         window = trapping_window(strip, 24 * strip.layers());
    const double slow = steady_driving(strip, 0.01), slower = steady_driving(strip, 0.005);
    EXPECT_NEAR(slower, window.starts,
                2. * std::abs(window.starts - coarse.starts) + 2. * std::abs(slower - slow) + 1e-8);
    EXPECT_LT(std::abs(slower / window.starts - 1.), 1e-5);
  }
}

TEST(SteadyCrack, SpeedIsTheInverseOfDriving)
{
  const CrackStrip strip{4, 0.5};
  for (const double speed : {0.3, 0.4, 0.5})
    EXPECT_NEAR(steady_speed(strip, steady_driving(strip, speed), 0.6), speed, 1e-8);
  EXPECT_THROW(steady_speed(strip, 1.2, 0.6), std::runtime_error); // trapped
  EXPECT_THROW(steady_speed(strip, 10., 0.6), std::runtime_error); // faster than 0.6
}

// Three facts about the fields that are not built into them: the bond that breaks at s = 0 then has the breaking
// elongation, the dashpots dissipate what the strip holds beyond the bond's energy, and far behind both faces hang
// free at the height of the held rows. The first two to the second order of the time step.
// theory-comparison.md, eqs. (S.6), (S.7) and (S.9).
TEST(SteadyFields, BreakAtTheBreakingElongationAndBalanceEnergy)
{
  const CrackStrip strip{4, 1.};
  const double duration = 1024., speed = 0.35;
  std::vector<double> steps, elongation_errors, energy_errors;
  for (const std::size_t samples : {4096u, 8192u, 16384u})
  {
    const SteadyFields fields = steady_fields(strip, speed, duration, samples);
    steps.push_back(duration / static_cast<double>(samples));
    EXPECT_EQ(fields.time[samples / 2], 0.);
    elongation_errors.push_back(std::abs(fields.elongation[samples / 2] - 1.));
    energy_errors.push_back(std::abs(fields.dissipation / (fields.driving * fields.driving - 1.) - 1.));
    EXPECT_NEAR(fields.elongation.back() / (fields.driving * std::sqrt(static_cast<double>(strip.layers()))), 1., 1e-5);
  }
  EXPECT_LT(elongation_errors.back(), 1e-3);
  EXPECT_LT(energy_errors.back(), 1e-3);
  EXPECT_NEAR(fitted_order(steps, elongation_errors), 2., 0.3);
  EXPECT_NEAR(fitted_order(steps, energy_errors), 2., 0.3);
}

// Only where other bonds stay whole is the solution one.
TEST(SteadyFields, SayWhereOtherBondsWouldBreak)
{
  const CrackStrip strip{9, 0.5};
  EXPECT_TRUE(steady_fields(strip, 0.3, 1024., 16384).exists());
  EXPECT_GT(steady_fields(strip, 0.47, 1024., 16384).largest_elsewhere, 1.);
  EXPECT_FALSE(steady_fields(strip, 0.1, 1024., 16384).exists()); // bonds would break too early
}

TEST(CrackRun, RefusesAnUnstableStepAndACrackThatDoesNotRun)
{
  CrackRunOptions options{{4, 3.}, 1.9};
  options.time_step = 0.1;
  EXPECT_THROW(run_crack(options), std::invalid_argument);
  options.driving = 1.1; // trapped
  options.time_step = 0.025;
  EXPECT_THROW(run_crack(options), std::runtime_error);
}

// Either side wrong by 1 %: what the simulator has too much of, the exact solution lacks. verify_test.py has the claim.
// theory-comparison.md, eqs. (S.2), (S.5), (S.8) and (S.9).
TEST(SteadyCrackClaim, FailsForOnePercent)
{
  const std::tuple<const char *, std::function<void(CrackRunOptions &)>, const char *> faults[] = {
    {"viscosity", [](CrackRunOptions &options) { options.strip.viscosity *= 1.01; }, "crack speed"},
    {"load", [](CrackRunOptions &options) { options.driving *= 1.01; }, "energy released"},
  };
  for (const auto &[name, planted, row] : faults)
  {
    const Results results = steady_cracks({0.5, {1.75}, 0., 0.05, planted}).results;
    EXPECT_GE(faults::failing(results, row), 1u) << name << "\n" << results.verdict_text(10);
  }
}

} // namespace steady_crack_test
