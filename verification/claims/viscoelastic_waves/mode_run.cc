#include "verification/claims/viscoelastic_waves/mode_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"

namespace latcon::claims
{
namespace
{

using Complex = std::complex<double>;

// Nonlinear terms change frequencies by the square of this.
constexpr double mode_strain = 1e-5;
// Largest w h and h / tau. Velocity Verlet has sin(w' h / 2) = w h / 2, so extrapolation leaves (3 / 2560) of the
// fourth power: 1.2e-7. The update of a branch leaves (h / tau)^4 / 2880 of its share, dashpots a term of the same
// order.
constexpr double share_per_step = 0.1;

double step_of(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
               const bridge::MemoryWave &wave)
{
  const double limit = 0.9 * lattice::time_step_limits(cell.sheet, material, smallest_stretch(cell.sheet, F)).combined;
  support::Extremes times;
  times.add(1. / std::abs(wave.rate));
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      if (const auto *memory = std::get_if<lattice::MaxwellMemory>(&shell->memory))
        for (const lattice::MaxwellMemory::Branch &branch : memory->branches())
          times.add(branch.relaxation_time);
  return support::smallest_of({limit, share_per_step * times.smallest()});
}

// The wave at t = 0: sites displaced from `at_rest`, velocities, overstresses.
lattice::State excited(const WaveCell &cell, const lattice::Material &material, const lattice::State &at_rest,
                       const bridge::MemoryWave &wave)
{
  const lattice::TriangularLattice &sheet = cell.sheet;
  const double amplitude = mode_strain / cell.K.norm();
  lattice::State state = at_rest;
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      const double shape = amplitude * std::cos(cell.K.dot(sheet.reference(place)));
      const Eigen::Vector2cd u = shape * wave.polarisation, v = wave.rate * u;
      state.x[place] += u.x().real();
      state.y[place] += u.y().real();
      state.vx[place] += v.x().real();
      state.vy[place] += v.y().real();
    }
  lattice::update_images(state, lattice::RowPartition(sheet));
  lattice::relax_memory(state, sheet, material);
  lattice::for_each_bond(
    at_rest, sheet,
    [&](const lattice::Bond &bond)
    {
      const auto [place, kind, far] = bond;
      const auto *memory = std::get_if<lattice::MaxwellMemory>(&material.shell(kind)->memory);
      if (memory == nullptr)
        return;
      const Eigen::Vector2d X = sheet.reference(place), R = sheet.bond_vector(kind);
      const Eigen::Vector2d n =
        Eigen::Vector2d(at_rest.x[far] - at_rest.x[place], at_rest.y[far] - at_rest.y[place]).normalized();
      const Complex stretch = amplitude * (std::cos(cell.K.dot(X + R)) - std::cos(cell.K.dot(X))) / R.norm() *
                              (n.x() * wave.polarisation.x() + n.y() * wave.polarisation.y());
      for (std::size_t i = 0; i < memory->branches().size(); ++i)
      {
        const auto &[modulus, time] = memory->branches()[i];
        state.history.kinds[kind].variables[i][place] =
          (modulus * wave.rate * time / (1. + wave.rate * time) * stretch).real();
      }
    });
  return state;
}

Oscillation measure(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                    const bridge::MemoryWave &wave, double time_step, std::size_t stride)
{
  const lattice::TriangularLattice &sheet = cell.sheet;
  const lattice::State at_rest = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  lattice::Simulation simulation(sheet, material, excited(cell, material, at_rest, wave), time_step);
  const Eigen::Vector2d direction = wave.polarisation.real().normalized();
  std::vector<double> amplitudes;
  const auto observe = [&]
  {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t row = 0; row < sheet.rows(); ++row)
      for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
      {
        const std::size_t place = sheet.index(row, column);
        sum += std::cos(cell.K.dot(sheet.reference(place))) *
               Eigen::Vector2d(simulation.state().x[place] - at_rest.x[place],
                               simulation.state().y[place] - at_rest.y[place]);
      }
    const double value = direction.dot(sum) * cell.K.norm() / mode_strain;
    if (!std::isfinite(value))
      throw std::runtime_error("a wave has an amplitude that is not finite");
    amplitudes.push_back(value);
  };
  constexpr double periods = 0.8;
  const auto samples = static_cast<std::size_t>(
    std::ceil(periods * 2. * M_PI / wave.frequency() / time_step / static_cast<double>(stride)));
  observe();
  for (std::size_t sample = 0; sample < samples; ++sample)
  {
    for (std::size_t step = 0; step < stride; ++step)
      simulation.step();
    observe();
  }
  return fit_oscillation(amplitudes, static_cast<double>(stride) * time_step);
}

} // namespace

Oscillation run_wave(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                     const bridge::MemoryWave &wave)
{
  if (!(wave.frequency() > 0.) || !std::isfinite(wave.frequency()) || !std::isfinite(wave.decay()))
    throw std::runtime_error("a wave does not oscillate: it is overdamped, or the sheet is unstable");
  const double time_step = step_of(cell, material, F, wave);
  constexpr double samples_per_period = 50.;
  const auto stride =
    std::max<std::size_t>(1, static_cast<std::size_t>(2. * M_PI / wave.frequency() / time_step / samples_per_period));
  const Oscillation coarse = measure(cell, material, F, wave, time_step, stride);
  Oscillation result = measure(cell, material, F, wave, 0.5 * time_step, 2 * stride);
  result.frequency += (result.frequency - coarse.frequency) / 3.;
  result.decay += (result.decay - coarse.decay) / 3.;
  return result;
}

} // namespace latcon::claims
