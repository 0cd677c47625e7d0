#include "lattice/chebyshev_stages.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "lattice/time_step.h"
#include "tests/lattice/plane_modes.h"

namespace
{

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
    EXPECT_EQ(stages.count(), s);
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
        fastest = std::max(fastest, std::abs(rate));
      }
      EXPECT_LT(fastest * limits.viscous, 1.);
      EXPECT_GT(fastest * limits.viscous, 0.4);
    }
}

} // namespace
