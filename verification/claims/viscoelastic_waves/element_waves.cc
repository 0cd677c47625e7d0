#include "verification/claims/viscoelastic_waves/element_waves.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/wave_sheet.h"

namespace latcon::claims
{
namespace
{

using Vector = continuum::Sheet::Vector;

constexpr double periods = 0.8;
// Of the wave; nonlinear terms change frequencies by its square.
constexpr double strain = 1e-4;

// The error is a series in h^2 with terms of (w h)^2 / 12 and w h^2 / (12 tau) (theory-viscoelastic.md, eq. (V.7)).
double step_of(const WaveContinuum &medium, const bridge::MemoryWave &wave)
{
  const double rate = std::abs(wave.rate);
  support::Extremes steps;
  steps.add(0.2 / rate);
  for (const continuum::MaxwellFibres &fibres : medium.memory->families())
    for (const continuum::MaxwellBranch &branch : fibres.branches)
      steps.add(std::sqrt(0.1 * branch.relaxation_time / rate));
  return steps.smallest();
}

// Relaxation times of branches by their numbers [s].
std::vector<double> relaxation_times(const continuum::FibreMemory &memory)
{
  std::vector<double> times(memory.n_numbers(), 0.);
  for (const continuum::MaxwellFibres &fibres : memory.families())
    for (std::size_t i = 0; i < fibres.branches.size(); ++i)
      times[fibres.first_number + i] = fibres.branches[i].relaxation_time;
  return times;
}

struct Measurement
{
  Oscillation oscillation;
  double imbalance;
};

Measurement measure(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                    const bridge::MemoryWave &wave, const WaveMesh &resolution, double time_step, std::size_t stride)
{
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, one_wavelength(K, resolution.cells));
  continuum::DynamicSettings settings{time_step};
  settings.degree = resolution.degree;
  continuum::DynamicSolver solver(mesh, medium.constitution, periodic_edges(), medium.inertia, settings,
                                  medium.viscosity, {}, medium.memory);
  const continuum::Sheet &sheet = solver.sheet();
  const Vector base = interpolated(sheet, bridge::AffineDisplacement(F));
  // At the phase of the wave, times `factor`, added to the homogeneous state or to nothing.
  const auto field = [&](const std::complex<double> &factor, bool is_on_base)
  {
    const Eigen::Vector2cd p = strain / K.norm() * factor * wave.polarisation;
    Vector nodal = interpolated(sheet, CosineWave(K, p.real()));
    if (is_on_base)
      nodal += base;
    return nodal;
  };
  // Re(s tau / (1 + s tau) p) is the strain of the spring, so that a branch is relaxed at Re(p / (1 + s tau)).
  std::vector<Vector> relaxed;
  for (const double time : relaxation_times(*medium.memory))
    relaxed.push_back(field(1. / (1. + wave.rate * time), true));
  solver.start(field(1., true), field(wave.rate, false), 0., relaxed);

  continuum::Sheet::Matrix mass;
  sheet.make_matrix(sheet.conformity_constraints(), mass);
  sheet.mass(medium.inertia.density, medium.inertia.length, sheet.conformity_constraints(), mass);
  const Vector shape = interpolated(sheet, CosineWave(K, wave.polarisation.real().normalized()));
  Vector weights = sheet.make_owned();
  mass.vmult(weights, shape);
  for (const auto i : sheet.owned())
    if (sheet.conformity_constraints().is_constrained(i))
      weights(i) = 0.;
  weights.compress(dealii::VectorOperation::insert);

  Vector ghosted = sheet.make_ghosted();
  ghosted = base;
  const double energy = solver.ledger().stored + solver.ledger().kinetic - sheet.energy(ghosted);
  std::vector<double> amplitudes;
  support::LargestError imbalance;
  const auto observe = [&]
  {
    Vector difference = sheet.make_owned();
    difference = solver.displacement();
    difference -= base;
    const double value = (weights * difference) * K.norm() / (strain * (weights * shape));
    if (!std::isfinite(value))
      throw std::runtime_error("a wave has an amplitude that is not finite");
    amplitudes.push_back(value);
    imbalance.add(std::abs(solver.ledger().imbalance) / energy);
  };
  const auto samples = static_cast<std::size_t>(
    std::ceil(periods * 2. * M_PI / wave.frequency() / time_step / static_cast<double>(stride)));
  observe();
  for (std::size_t sample = 0; sample < samples; ++sample)
  {
    for (std::size_t step = 0; step < stride; ++step)
      solver.step();
    observe();
  }
  return {fit_oscillation(amplitudes, static_cast<double>(stride) * time_step), imbalance.error()};
}

} // namespace

std::vector<bridge::BranchMatrix> branch_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                  const Eigen::Vector2d &K)
{
  const double mass = medium.inertia.density * (1. + medium.inertia.length * medium.inertia.length * K.squaredNorm());
  std::vector<bridge::BranchMatrix> branches;
  for (const continuum::MaxwellFibres &fibres : medium.memory->families())
  {
    const Eigen::Vector2d N(fibres.direction[0], fibres.direction[1]), n = (F * N).normalized();
    const Eigen::Matrix2d per_modulus = fibres.weight * std::pow(N.dot(K), 2) / mass * n * n.transpose();
    for (const auto &[modulus, time] : fibres.branches)
    {
      const auto same =
        std::find_if(branches.begin(), branches.end(),
                     [time = time](const bridge::BranchMatrix &b) { return b.relaxation_time == time; });
      if (same == branches.end())
        branches.push_back({modulus * per_modulus, time});
      else
        same->stiffness += modulus * per_modulus;
    }
  }
  return branches;
}

std::array<bridge::MemoryWave, 2> continuum_memory_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                         const Eigen::Vector2d &K)
{
  return bridge::memory_waves(continuum_matrices(medium, F, K), branch_matrices(medium, F, K),
                              bridge::wave_normal(F, K));
}

ElementWave run_element_wave(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                             const bridge::MemoryWave &wave, const WaveMesh &mesh)
{
  if (!(wave.frequency() > 0.) || !std::isfinite(wave.frequency()) || !std::isfinite(wave.decay()))
    throw std::runtime_error("a wave does not oscillate: it is overdamped, or the sheet is unstable");
  const double time_step = step_of(medium, wave), rate = std::abs(wave.rate);
  constexpr double samples_per_period = 25.;
  const auto stride =
    std::max<std::size_t>(1, static_cast<std::size_t>(2. * M_PI / wave.frequency() / time_step / samples_per_period));
  const Measurement coarse = measure(medium, F, K, wave, mesh, time_step, stride),
                    fine = measure(medium, F, K, wave, mesh, 0.5 * time_step, 2 * stride);
  ElementWave result{fine.oscillation, fine.imbalance, 0.};
  result.oscillation.frequency += (fine.oscillation.frequency - coarse.oscillation.frequency) / 3.;
  result.oscillation.decay += (fine.oscillation.decay - coarse.oscillation.decay) / 3.;
  result.imbalance_tolerance = std::pow(rate * 0.5 * time_step, 2) / 6. * periods * 2. * M_PI * rate / wave.frequency();
  return result;
}

} // namespace latcon::claims
