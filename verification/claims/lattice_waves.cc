#include "verification/claims/lattice_waves.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "verification/bridge/bloch.h"

namespace latcon::claims
{
namespace
{

// Nonlinear terms change frequencies by the square of this; positions of a hundred spacings are rounded to 1e-9 of the
// displacements it makes.
constexpr double strain = 1e-5;

// Largest w h. Velocity Verlet has sin(w' h / 2) = w h / 2, so extrapolation leaves (3 / 2560) of its fourth power:
// 2e-7.
constexpr double phase_per_step = 0.12;

std::array<Oscillation, 2> measure(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                                   const std::array<bridge::PlaneWave, 2> &waves, const lattice::TimeStepping &stepping,
                                   std::size_t stride)
{
  const double time_step = stepping.step;
  const lattice::TriangularLattice &sheet = cell.sheet;
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  const lattice::State at_rest = state;
  const double amplitude = strain / cell.K.norm();
  std::vector<std::size_t> places;
  std::vector<double> shapes; // cos K.X at the places
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      places.push_back(place);
      shapes.push_back(std::cos(cell.K.dot(sheet.reference(place))));
      for (const bridge::PlaneWave &wave : waves)
      {
        state.x[place] += amplitude * shapes.back() * wave.polarisation.x();
        state.y[place] += amplitude * shapes.back() * wave.polarisation.y();
      }
    }
  lattice::Simulation simulation(sheet, material, std::move(state), stepping);

  std::array<std::vector<double>, 2> amplitudes;
  std::array<unsigned int, 2> sign_changes{};
  const auto observe = [&]
  {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double norm = 0.;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const std::size_t place = places[i];
      sum += shapes[i] * Eigen::Vector2d(simulation.state().x[place] - at_rest.x[place],
                                         simulation.state().y[place] - at_rest.y[place]);
      norm += shapes[i] * shapes[i];
    }
    for (std::size_t w = 0; w < 2; ++w)
    {
      const double value = waves[w].polarisation.dot(sum) / (amplitude * norm);
      if (!std::isfinite(value))
        throw std::runtime_error("a wave has an amplitude that is not finite");
      if (!amplitudes[w].empty() && value * amplitudes[w].back() < 0.)
        ++sign_changes[w];
      amplitudes[w].push_back(value);
    }
  };
  observe();
  // A wave turns twice within three quarters of its damped period; one that is overdamped never does. The undamped
  // period tells them apart, in as many steps as dashpots leave time for.
  constexpr double most_periods = 2., most_steps = 5e6;
  const double slowest = support::smallest_of({waves[0].frequency, waves[1].frequency});
  const auto max_steps =
    static_cast<std::size_t>(support::smallest_of({most_steps, most_periods * 2. * M_PI / (slowest * time_step)}));
  for (std::size_t step = 1; std::min<unsigned int>(sign_changes[0], sign_changes[1]) < 2; ++step)
  {
    if (step > max_steps)
      throw std::runtime_error("a wave of the lattice did not oscillate: it is overdamped, or unstable");
    simulation.step();
    if (step % stride == 0)
      observe();
  }
  const double sampling = static_cast<double>(stride) * time_step;
  return {fit_oscillation(amplitudes[0], sampling), fit_oscillation(amplitudes[1], sampling)};
}

// Periods of the lattice along x and y, over d.
Eigen::Vector2d periods(lattice::Orientation orientation)
{
  return orientation == lattice::Orientation::rows_along_crack ? Eigen::Vector2d(1., std::sqrt(3.))
                                                               : Eigen::Vector2d(std::sqrt(3.), 1.);
}

Eigen::Vector2d reciprocal(const WaveDirection &direction, lattice::Orientation orientation)
{
  return Eigen::Array2d(direction.along_x, direction.along_y) / periods(orientation).array();
}

} // namespace

std::array<WaveDirection, 4> wave_directions(lattice::Orientation orientation)
{
  const bool rows_along_x = orientation == lattice::Orientation::rows_along_crack;
  return {{{1, 0}, {rows_along_x ? 1u : 3u, 1}, {0, 1}, {1, 2}}};
}

Eigen::Vector2d unit_vector(const WaveDirection &direction, lattice::Orientation orientation)
{
  return reciprocal(direction, orientation).normalized();
}

double angle(const WaveDirection &direction, lattice::Orientation orientation)
{
  const Eigen::Vector2d N = unit_vector(direction, orientation);
  return std::atan2(N.y(), N.x()) * 180. / M_PI;
}

WaveCell wave_cell(double spacing, lattice::Orientation orientation, const WaveDirection &direction, double kd)
{
  const Eigen::Vector2d period = spacing * periods(orientation);
  const Eigen::Vector2d unit = 2. * M_PI / spacing * reciprocal(direction, orientation);
  constexpr double tolerance = 0.02;
  // K = unit j / n, over n periods along each direction in which it is not constant.
  for (unsigned int j = 1;; ++j)
  {
    const double n = std::round(j * unit.norm() * spacing / kd);
    const double found = j * unit.norm() * spacing / n;
    // Two sites along a row are the least that a periodic sheet takes.
    if (n < 2. || std::abs(found / kd - 1.) > tolerance)
      continue;
    const auto extent = [&](unsigned int along, double one) { return (along > 0 ? n : one > spacing ? 1. : 2.) * one; };
    return {{spacing,
             extent(direction.along_x, period.x()),
             extent(direction.along_y, period.y()),
             orientation,
             {true, true}},
            unit * j / n};
  }
}

double smallest_stretch(const lattice::TriangularLattice &lattice, const Eigen::Matrix2d &F)
{
  support::Extremes stretches;
  stretches.add(1.);
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    stretches.add((F * lattice.bond_vector(kind)).norm() / lattice.rest_length(kind));
  return stretches.smallest();
}

std::array<Oscillation, 2> lattice_waves(const WaveCell &cell, const lattice::Material &material,
                                         const Eigen::Matrix2d &F, const input::Case::Integrator integrator)
{
  const bool chebyshev = integrator == input::Case::Integrator::runge_kutta_chebyshev;
  const std::array<bridge::PlaneWave, 2> waves = bridge::bloch_waves(cell.sheet, material, F, cell.K);
  const double shortest = smallest_stretch(cell.sheet, F);
  const lattice::TimeStepLimits limits = lattice::time_step_limits(cell.sheet, material, shortest);
  const double limit = 0.9 * (chebyshev ? lattice::chebyshev_step(cell.sheet, material, shortest) : limits.combined);
  const double fastest = bridge::fastest_frequency(waves);
  const double longest = support::smallest_of({limit, phase_per_step / fastest});
  const lattice::TimeStepping coarsest =
    chebyshev ? lattice::chebyshev_time_stepping(longest, limits, 0) : lattice::TimeStepping(longest);
  const double time_step = coarsest.step;
  // Dashpots can ask for steps so short that there is no error to extrapolate, and no news in every step.
  const double phase = fastest * time_step;
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * phase_per_step / phase));
  constexpr double no_error = 1e-3; // its square over 24 is 4e-8
  if (phase < no_error)
    return measure(cell, material, F, waves, coarsest, stride);

  const std::array<Oscillation, 2> coarse = measure(cell, material, F, waves, coarsest, stride);
  // With as many stages, on which the constants of the error depend.
  std::array<Oscillation, 2> result = measure(cell, material, F, waves, {0.5 * time_step, coarsest.stages}, 2 * stride);
  for (std::size_t w = 0; w < 2; ++w)
  {
    result[w].frequency += (result[w].frequency - coarse[w].frequency) / 3.;
    result[w].decay += (result[w].decay - coarse[w].decay) / 3.;
  }
  return result;
}

} // namespace latcon::claims
