#include "lattice/relaxation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "lattice/forces.h"
#include "lattice/time_step.h"
#include "support/require.h"

namespace latcon::lattice
{
namespace
{

struct Sums
{
  double power = 0., velocity_square = 0., force_square = 0., largest_force_square = 0.;

  void add(const Sums &other)
  {
    power += other.power;
    velocity_square += other.velocity_square;
    force_square += other.force_square;
    largest_force_square = std::max(largest_force_square, other.largest_force_square);
  }
};

// Rows are shared out among threads, each with its own sums, which are added row after row: the same bits for any
// number of threads.
template <class SiteOperation>
Sums over_free_sites(const State &state, const TriangularLattice &lattice, const SiteOperation &operation)
{
  std::vector<Sums> rows(lattice.rows());
  const auto of_row = [&](std::size_t row)
  {
    const std::size_t first = lattice.index(row, 0);
    Sums sums; // not in place: neighbouring rows share cache lines
    for (std::size_t i = first; i < first + lattice.columns(); ++i)
      if (state.inverse_mass[i] > 0.)
        operation(i, sums);
    rows[row] = sums;
  };
  for_each_row(lattice, {0, lattice.rows()}, of_row);
  Sums total;
  for (const Sums &sums : rows)
    total.add(sums);
  return total;
}

} // namespace

double relax(State &state, const TriangularLattice &lattice, const Material &material, double tolerance,
             std::size_t max_iterations)
{
  support::require(std::all_of(state.rollers.begin(), state.rollers.end(), [](auto along) { return along == 0; }),
                   "relaxation does not know rollers");
  // Constants of the cited paper.
  constexpr double initial_mixing = 0.1, mixing_decay = 0.99, speed_up = 1.1, slow_down = 0.5;
  constexpr std::size_t patience = 5;

  const Material springs = without_dashpots(material);
  constexpr double smallest_stretch = 0.5;
  const double largest_step = 0.9 * time_step_limits(lattice, springs, smallest_stretch).elastic;

  const RowPartition band(lattice);
  Forces forces(band, springs);
  state.velocity = VectorField(lattice.n_places());
  update_images(state, band);
  double step = 0.3 * largest_step, mixing = initial_mixing;
  std::size_t downhill = 0;
  double residual = 0.;
  for (std::size_t iteration = 0; iteration <= max_iterations; ++iteration)
  {
    forces.evaluate(state, state.velocity);
    const Sums sums = over_free_sites(state, lattice,
                                      [&](std::size_t i, Sums &row)
                                      {
                                        const Eigen::Vector2d f = forces.on_sites().at(i), v = state.velocity.at(i);
                                        row.add({f.dot(v), v.squaredNorm(), f.squaredNorm(), f.squaredNorm()});
                                      });
    residual = std::sqrt(std::isfinite(sums.force_square) ? sums.largest_force_square : sums.force_square);
    if (residual <= tolerance)
    {
      state.velocity = VectorField(lattice.n_places());
      return residual;
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
    over_free_sites(state, lattice,
                    [&](std::size_t i, Sums &)
                    {
                      const Eigen::Vector2d f = forces.on_sites().at(i), v = state.velocity.at(i);
                      const Eigen::Vector2d turned =
                        uphill ? Eigen::Vector2d(0., 0.) : (1. - mixing) * v + along_force * f;
                      state.velocity.set(i, turned + step * f * state.inverse_mass[i]);
                      state.position.add(i, step * state.velocity.at(i));
                    });
    update_images(state, band);
  }
  std::ostringstream message;
  message << "the lattice did not come to rest: largest force on a free site " << residual << " N/m, wanted "
          << tolerance << " N/m after at most " << max_iterations << " iterations";
  throw std::runtime_error(message.str());
}

} // namespace latcon::lattice
