// Motions that are reversed, and small ones that are superposed.
#include <cmath>

#include <gtest/gtest.h>

#include "lattice/simulation.h"
#include "support/largest_error.h"
#include "tests/lattice/smooth_motion.h"

namespace time_reversal_test
{

using namespace latcon;

using namespace lattice;

// A sheet sent back comes home.
struct Return
{
  double from_home; // largest distance of a site from where it began, after the way out and back [m]
  double way;       // the same after the way out
  double bound;     // of the former by round-off [m]
};

Return there_and_back(double viscosity)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber(viscosity);
  State state = homogeneous_state(sheet, material, sheets::stretched(1.5, 1.4), Edges::held);
  add_noise(state, sheet, 0.1 * sheets::spacing, 1);
  const State home = state;
  const double share = 0.5;
  Simulation simulation(sheet, material, std::move(state), share * time_step_limits(sheet, material, 0.5).combined);
  constexpr std::size_t steps = 500;
  const auto distance = [&]
  {
    double largest = 0.;
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      largest = support::largest_of({largest, std::hypot(simulation.state().x[place] - home.x[place],
                                                         simulation.state().y[place] - home.y[place])});
    return largest;
  };
  for (std::size_t step = 0; step < steps; ++step)
    simulation.step();
  Return result{0., distance(), 0.};
  Field vx = simulation.state().vx, vy = simulation.state().vy;
  for (Field *field : {&vx, &vy})
    for (double &v : *field)
      v = -v;
  simulation.set_velocities(vx, vy);
  for (std::size_t step = 0; step < steps; ++step)
    simulation.step();
  result.from_home = distance();
  // Each step rounds each coordinate, less than 1.5 times the sheet's length, once, by 2^-53 of it at most; rounding of
  // velocities and forces moves a site by less. What a rounding leaves is an oscillation, no more than
  // 1 / sqrt(1 - (omega h / 2)^2) times as large, h being `share` of the limit. A site has 2 coordinates, and all
  // roundings of a vibration may meet at one site: the norm over all sites bounds the largest.
  const double rounding = std::ldexp(1.5 * sheet.length(), -53) * std::sqrt(2. * static_cast<double>(sheet.n_sites()));
  result.bound = 2. * steps * rounding / std::sqrt(1. - share * share);
  return result;
}

TEST(TimeReversal, VerletWithoutDashpotsComesBack)
{
  const Return without = there_and_back(0.);
  EXPECT_GT(without.way, 0.05 * sheets::spacing);
  EXPECT_LT(without.from_home, without.bound);
  EXPECT_LT(without.bound, 1e-8 * without.way);
  const Return with = there_and_back(65.625);
  EXPECT_GT(with.from_home, 0.01 * with.way) << "dashpots do not give back what they took";
}

// Small motions of a loaded sheet add up; what is left falls with the square of their size.
TEST(Superposition, HoldsInTheSmall)
{
  const TriangularLattice sheet = sheets::square(12);
  const Material material = sheets::rubber();
  const double h = 0.5 * time_step_limits(sheet, material, 0.5).combined;
  const auto moved = [&](double first, double second)
  {
    Simulation simulation(sheet, material, homogeneous_state(sheet, material, sheets::stretched(1.5, 1.4), Edges::held),
                          h);
    Field vx(sheet.n_places()), vy(sheet.n_places());
    for (std::size_t i = 0; i < vx.size(); ++i)
    {
      const Eigen::Vector2d X = sheet.reference(i) / sheets::spacing;
      vx[i] = first * std::sin(0.5 * X.x()) * std::cos(0.4 * X.y());
      vy[i] = second * std::cos(0.3 * X.x() + 0.5 * X.y());
    }
    simulation.set_velocities(vx, vy);
    for (int step = 0; step < 300; ++step)
      simulation.step();
    return simulation.state();
  };
  const State rest = moved(0., 0.);
  const auto remainder = [&](double v)
  {
    const State one = moved(v, 0.), other = moved(0., v);
    State sum = moved(v, v);
    for (std::size_t i = 0; i < sum.x.size(); ++i)
    {
      sum.x[i] -= other.x[i] - rest.x[i];
      sum.y[i] -= other.y[i] - rest.y[i];
    }
    return smooth_motion::distance(sum, one) / smooth_motion::distance(one, rest);
  };
  // Relative to the motion itself.
  EXPECT_NEAR(std::log2(remainder(0.4) / remainder(0.1)) / 2., 1., 0.1);
  EXPECT_LT(remainder(0.1), 0.05);
}

} // namespace time_reversal_test
