#include "verification/claims/lattice_waves.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <variant>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "verification/claims/bonds.h"
#include "verification/claims/spectrum.h"

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

// Follows waves of the lattice. @param start displaced from `at_rest` along `directions`, in a cosine for each
std::vector<Oscillation> measure(const WaveCell &cell, const lattice::Material &material, const lattice::State &at_rest,
                                 lattice::State start, const std::vector<Eigen::Vector2d> &directions,
                                 const Sampling &sampling, unsigned int stages, std::size_t max_steps)
{
  lattice::Simulation simulation(cell.sheet, material, std::move(start),
                                 lattice::TimeStepping(sampling.time_step, stages));
  lattice::Field shape(cell.sheet.n_places(), 0.); // cos(K.X) at the sites
  for (const std::size_t place : cell.sheet.sites())
    shape[place] = std::cos(cell.phase(place));
  const double norm = std::inner_product(shape.begin(), shape.end(), shape.begin(), 0.);
  const auto amplitudes = [&]
  {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t place = 0; place < shape.size(); ++place)
      sum += shape[place] * (simulation.state().position.at(place) - at_rest.position.at(place));
    std::vector<double> of_waves;
    for (const Eigen::Vector2d &direction : directions)
      of_waves.push_back(direction.dot(sum) / (strain / cell.K.norm() * norm));
    return of_waves;
  };
  return followed(sampling, max_steps, "the lattice", amplitudes, [&] { simulation.step(); });
}

// Largest w h and h / tau. Velocity Verlet has sin(w' h / 2) = w h / 2, so extrapolation leaves (3 / 2560) of the
// fourth power: 1.2e-7. The update of a branch leaves (h / tau)^4 / 2880 of its share, dashpots a term of the same
// order.
constexpr double share_per_step = 0.1;

double memory_step(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                   const bridge::MemoryWave &wave)
{
  const double limit = 0.9 * lattice::time_step_limits(cell.sheet, material, smallest_stretch(cell.sheet, F)).combined;
  support::Extremes times;
  times.add(1. / std::abs(wave.rate));
  for (const double time : relaxation_times(material))
    times.add(time);
  return support::smallest_of({limit, share_per_step * times.smallest()});
}

// The wave at t = 0: sites displaced from `at_rest`, velocities, overstresses.
lattice::State excited(const WaveCell &cell, const lattice::Material &material, const lattice::State &at_rest,
                       const bridge::MemoryWave &wave)
{
  const lattice::TriangularLattice &sheet = cell.sheet;
  const double amplitude = strain / cell.K.norm();
  lattice::State state = at_rest;
  for (const std::size_t place : sheet.sites())
  {
    const double shape = amplitude * std::cos(cell.phase(place));
    const Eigen::Vector2cd u = shape * wave.polarisation, v = wave.rate * u;
    state.position.add(place, u.real());
    state.velocity.add(place, v.real());
  }
  lattice::update_images(state, lattice::RowPartition(sheet));
  lattice::relax_memory(state, sheet, material);
  for (const auto &[place, kind, far] : bonds(at_rest, sheet))
  {
    const auto *memory = std::get_if<lattice::MaxwellMemory>(&material.shell(kind)->memory);
    if (memory == nullptr)
      continue;
    const Eigen::Vector2d X = sheet.reference(place), R = sheet.bond_vector(kind);
    const Eigen::Vector2d n = (at_rest.position.at(far) - at_rest.position.at(place)).normalized();
    const std::complex<double> stretch = amplitude * (std::cos(cell.K.dot(X + R)) - std::cos(cell.K.dot(X))) /
                                         R.norm() * (n.x() * wave.polarisation.x() + n.y() * wave.polarisation.y());
    for (std::size_t i = 0; i < memory->branches().size(); ++i)
    {
      const auto &[modulus, time] = memory->branches()[i];
      state.history.kinds[kind].variables[i][place] =
        (modulus * wave.rate * time / (1. + wave.rate * time) * stretch).real();
    }
  }
  return state;
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

void add_wave(lattice::State &state, const WaveCell &cell, double amplitude, const Eigen::Vector2d &p, double frequency)
{
  for (const std::size_t place : cell.sheet.sites())
  {
    const double phase = cell.phase(place);
    const Eigen::Vector2d u = amplitude * std::cos(phase) * p, v = amplitude * frequency * std::sin(phase) * p;
    state.position.add(place, u);
    state.velocity.add(place, v);
  }
}

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

std::vector<Oscillation> lattice_waves(const WaveCell &cell, const lattice::Material &material,
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
  const lattice::State at_rest = lattice::homogeneous_state(cell.sheet, material, F, lattice::Edges::free);
  lattice::State start = at_rest; // both standing waves, released from rest
  for (const bridge::PlaneWave &wave : waves)
    add_wave(start, cell, strain / cell.K.norm(), wave.polarisation);
  const auto run = [&](const Sampling &sampling)
  {
    // The undamped period tells overdamped waves apart, in as many steps as dashpots leave time for.
    constexpr double most_periods = 2., most_steps = 5e6;
    const double slowest = support::smallest_of({waves[0].frequency, waves[1].frequency});
    const double steps = support::smallest_of({most_steps, most_periods * 2. * M_PI / (slowest * sampling.time_step)});
    // The halves with as many stages, on which the constants of the error depend.
    return measure(cell, material, at_rest, start, {waves[0].polarisation, waves[1].polarisation}, sampling,
                   coarsest.stages, static_cast<std::size_t>(steps));
  };
  // Dashpots can ask for steps so short that there is no error to extrapolate, and no news in every step.
  const double phase = fastest * coarsest.step;
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(0.5 * phase_per_step / phase));
  constexpr double no_error = 1e-3; // its square over 24 is 4e-8
  const Sampling sampling{coarsest.step, stride};
  return phase < no_error ? run(sampling) : extrapolated(sampling, 2 * stride, run);
}

Oscillation lattice_wave(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                         const bridge::MemoryWave &wave)
{
  const lattice::State at_rest = lattice::homogeneous_state(cell.sheet, material, F, lattice::Edges::free);
  const lattice::State start = excited(cell, material, at_rest, wave);
  const Sampling sampling = sampling_of(wave.frequency(), wave.decay(), memory_step(cell, material, F, wave), 50.);
  return extrapolated(sampling, 2 * sampling.stride,
                      [&](const Sampling &of)
                      {
                        return measure(cell, material, at_rest, start, {wave.polarisation.real().normalized()}, of, 0,
                                       of.n_samples * of.stride);
                      })[0];
}

} // namespace latcon::claims
