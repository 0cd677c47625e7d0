#include "lattice/relaxation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "lattice/time_step.h"
#include "lattice/velocity_verlet.h"

namespace lattice
{
namespace
{

struct Sums
{
  double power = 0., velocity_square = 0., force_square = 0., largest_force_square = 0.;
};

Sums sums_over_free_sites(const State &state, const Forces &forces)
{
  Sums sums;
  for (std::size_t i = 0; i < state.x.size(); ++i)
    if (state.inverse_mass[i] > 0.)
    {
      const double fx = forces.fx()[i], fy = forces.fy()[i];
      const double force_square = fx * fx + fy * fy;
      sums.power += fx * state.vx[i] + fy * state.vy[i];
      sums.velocity_square += state.vx[i] * state.vx[i] + state.vy[i] * state.vy[i];
      sums.force_square += force_square;
      // Written so that a NaN is kept.
      if (!(force_square <= sums.largest_force_square))
        sums.largest_force_square = force_square;
    }
  return sums;
}

} // namespace

Relaxation relax(State &state, const TriangularLattice &lattice, const Material &material, double tolerance,
                 std::size_t max_iterations)
{
  // Constants of the cited paper.
  constexpr double initial_mixing = 0.1, mixing_decay = 0.99, speed_up = 1.1, slow_down = 0.5;
  constexpr std::size_t patience = 5;

  Material springs = material;
  springs.nearest.viscosity = 0.;
  if (springs.next_nearest)
    springs.next_nearest->viscosity = 0.;
  constexpr double smallest_stretch = 0.5;
  const double largest_step = 0.9 * time_step_limits(lattice, springs, smallest_stretch).elastic;

  Forces forces(lattice, springs);
  std::fill(state.vx.begin(), state.vx.end(), 0.);
  std::fill(state.vy.begin(), state.vy.end(), 0.);
  double step = 0.3 * largest_step;
  double mixing = initial_mixing;
  std::size_t downhill = 0;
  double residual = 0.;
  for (std::size_t iteration = 0; iteration <= max_iterations; ++iteration)
  {
    forces.evaluate(state, state.vx, state.vy);
    const Sums sums = sums_over_free_sites(state, forces);
    residual = std::sqrt(sums.largest_force_square);
    if (residual <= tolerance)
    {
      std::fill(state.vx.begin(), state.vx.end(), 0.);
      std::fill(state.vy.begin(), state.vy.end(), 0.);
      return {iteration, residual};
    }
    if (!std::isfinite(residual))
      break;

    const bool uphill = sums.power < 0.;
    if (uphill)
    {
      step *= slow_down;
      mixing = initial_mixing;
      downhill = 0;
    }
    else if (++downhill > patience)
    {
      step = std::min(step * speed_up, largest_step);
      mixing *= mixing_decay;
    }
    const double along_force =
      sums.force_square > 0. ? mixing * std::sqrt(sums.velocity_square / sums.force_square) : 0.;
    for (std::size_t i = 0; i < state.x.size(); ++i)
    {
      const double inverse_mass = state.inverse_mass[i];
      if (!(inverse_mass > 0.))
        continue;
      const double fx = forces.fx()[i], fy = forces.fy()[i];
      state.vx[i] = uphill ? 0. : (1. - mixing) * state.vx[i] + along_force * fx;
      state.vy[i] = uphill ? 0. : (1. - mixing) * state.vy[i] + along_force * fy;
      state.vx[i] += step * fx * inverse_mass;
      state.vy[i] += step * fy * inverse_mass;
      state.x[i] += step * state.vx[i];
      state.y[i] += step * state.vy[i];
    }
  }
  std::ostringstream message;
  message << "the lattice did not come to rest: largest force on a free site " << residual << " N/m, wanted "
          << tolerance << " N/m after at most " << max_iterations << " iterations";
  throw std::runtime_error(message.str());
}

} // namespace lattice
