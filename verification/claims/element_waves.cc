#include <cmath>
#include <complex>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include "continuum/meshes.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/continuum_waves.h"

namespace latcon::claims
{
namespace
{

using Vector = continuum::Sheet::Vector;

// Displacement p cos(K.X - phase) [m].
class CosineWave : public dealii::Function<2>
{
public:
  CosineWave(const Eigen::Vector2d &K, const Eigen::Vector2d &p, double phase = 0.)
    : dealii::Function<2>(2), K_(K), p_(p), phase_(phase)
  {
  }
  double value(const dealii::Point<2> &X, unsigned int i) const override
  {
    return p_[i] * std::cos(K_.x() * X[0] + K_.y() * X[1] - phase_);
  }

private:
  Eigen::Vector2d K_, p_;
  double phase_;
};

// A periodic rectangle with `cells` per wavelength along each direction in which the wave K varies, and two across
// where it does not.
continuum::Rectangle one_wavelength(const Eigen::Vector2d &K, unsigned int cells)
{
  const bool along_x = std::abs(K.x()) > 1e-9 * K.norm(), along_y = std::abs(K.y()) > 1e-9 * K.norm();
  const double cell = 2. * M_PI / (K.norm() * cells);
  continuum::Rectangle rectangle{2. * cell, 2. * cell, 2, 2, true, true};
  if (along_x)
  {
    rectangle.length = 2. * M_PI / std::abs(K.x());
    rectangle.cells_x = cells;
  }
  if (along_y)
  {
    rectangle.height = 2. * M_PI / std::abs(K.y());
    rectangle.cells_y = cells;
  }
  return rectangle;
}

continuum::BoundaryConditions periodic_edges()
{
  continuum::BoundaryConditions conditions;
  conditions.periodic = {{continuum::edge::left, continuum::edge::right, 0},
                         {continuum::edge::bottom, continuum::edge::top, 1}};
  return conditions;
}

// A sheet at a homogeneous state, with its mass matrix.
struct WaveSheet
{
  WaveSheet(const WaveContinuum &medium, const continuum::Sheet &of, const Eigen::Matrix2d &F)
    : sheet(of), base(interpolated(of, bridge::AffineDisplacement(F)))
  {
    sheet.make_matrix(sheet.conformity_constraints(), mass);
    sheet.add_mass(medium.inertia.density, medium.inertia.length, sheet.conformity_constraints(), mass);
  }

  /// A x without the rows of dependent unknowns; the prescribed values are zero.
  Vector weighted(const continuum::Sheet::Matrix &A, const Vector &x) const
  {
    Vector b = sheet.make_owned();
    A.vmult(b, x);
    sheet.conformity_constraints().set_zero(b);
    return b;
  }

  const continuum::Sheet &sheet;
  Vector base; // displacement of the homogeneous state [m]
  continuum::Sheet::Matrix mass;
};

// Nodal values of both waves of a continuum without viscosity.
std::array<Vector, 2> elastic_waves(const WaveContinuum &medium, const continuum::Sheet &sheet,
                                    const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  const auto waves = continuum_waves({medium.constitution, medium.inertia}, F, K);
  return {interpolated(sheet, CosineWave(K, waves[0].polarisation)),
          interpolated(sheet, CosineWave(K, waves[1].polarisation))};
}

// Energy [J/m] of a sheet with these nodal values.
double energy(const continuum::Sheet &sheet, const Vector &nodal)
{
  return sheet.energy(sheet.with_ghosts(nodal));
}

// A periodic mesh as long as the wave K.
struct WaveRectangle
{
  WaveRectangle(const Eigen::Vector2d &K, unsigned int cells) : rectangle(one_wavelength(K, cells)), mesh(MPI_COMM_SELF)
  {
    continuum::make_rectangle(mesh, rectangle);
  }
  double area() const { return rectangle.length * rectangle.height; }

  continuum::Rectangle rectangle;
  continuum::Sheet::Mesh mesh;
};

// Such a sheet in motion.
struct MovingSheet : WaveRectangle
{
  MovingSheet(const WaveContinuum &medium, const Eigen::Vector2d &K, const WaveMesh &resolution,
              const continuum::DynamicSettings &settings)
    : WaveRectangle(K, resolution.cells), solver(mesh, medium.constitution, periodic_edges(), medium.inertia, settings,
                                                 medium.viscosity.get(), medium.memory.get())
  {
  }
  // Displacement from that of a state [m].
  Vector displacement_from(const Vector &base) const
  {
    Vector difference = solver.sheet().without_ghosts(solver.displacement());
    difference -= base;
    return difference;
  }

  continuum::DynamicSolver solver;
};

continuum::DynamicSettings settings_for(double time_step, const WaveMesh &resolution, double relative_tolerance)
{
  continuum::DynamicSettings settings{time_step};
  settings.degree = resolution.degree;
  settings.relative_tolerance = relative_tolerance;
  settings.keeps_tangent = true;
  return settings;
}

// Follows waves with shapes in the nodal values of a sheet that has started. @param at_rest sheet of `moving`
// @param amplitude of the start, in shapes [m] @param look called with each sample
std::vector<Oscillation> measure(
  MovingSheet &moving, const WaveSheet &at_rest, const std::vector<Vector> &shapes, double amplitude,
  const Sampling &sampling, std::size_t max_steps, const std::function<void()> &look = [] {})
{
  std::vector<Vector> weights;
  for (const Vector &shape : shapes)
    weights.push_back(at_rest.weighted(at_rest.mass, shape));
  const auto amplitudes = [&]
  {
    look();
    const Vector difference = moving.displacement_from(at_rest.base);
    std::vector<double> of_waves;
    for (std::size_t w = 0; w < shapes.size(); ++w)
      of_waves.push_back(weights[w] * difference / (amplitude * (weights[w] * shapes[w])));
    return of_waves;
  };
  return followed(sampling, max_steps, "the finite element sheet", amplitudes, [&] { moving.solver.step(); });
}

// Amplitude of a wave; nonlinear terms change frequencies by its square.
constexpr double element_strain = 1e-4;

// Relaxation times of branches by their numbers [s].
std::vector<double> relaxation_times(const continuum::FibreMemory &memory)
{
  std::vector<double> times(memory.n_numbers(), 0.);
  for (const continuum::MaxwellFibres &fibres : memory.families())
    for (std::size_t i = 0; i < fibres.branches.size(); ++i)
      times[fibres.first_number + i] = fibres.branches[i].relaxation_time;
  return times;
}

// The error is a series in h^2 with terms of (w h)^2 / 12 and w h^2 / (12 tau) (theory-viscoelastic.md, eq. (V.7)).
double memory_step(const WaveContinuum &medium, const bridge::MemoryWave &wave)
{
  const double rate = std::abs(wave.rate);
  support::Extremes steps;
  steps.add(0.2 / rate);
  for (const double time : relaxation_times(*medium.memory))
    steps.add(std::sqrt(0.1 * time / rate));
  return steps.smallest();
}

} // namespace

Vector interpolated(const continuum::Sheet &sheet, const dealii::Function<2> &field)
{
  Vector nodal = sheet.make_owned();
  dealii::VectorTools::interpolate(sheet.mapping(), sheet.dof_handler(), field, nodal);
  return nodal;
}

std::array<bridge::PlaneWave, 2> discrete_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                const Eigen::Vector2d &K, const WaveMesh &resolution)
{
  const WaveRectangle of_wave(K, resolution.cells);
  const continuum::Sheet sheet(of_wave.mesh, medium.constitution, resolution.degree, periodic_edges());
  const WaveSheet at_rest(medium, sheet, F);
  const Vector u = sheet.with_ghosts(at_rest.base);
  continuum::Sheet::Matrix stiffness;
  sheet.make_matrix(sheet.conformity_constraints(), stiffness);
  sheet.tangent(u, sheet.conformity_constraints(), stiffness);

  // Both waves at once, by inverse iteration with a shift below them. Translations by whole cells keep waves of other
  // wave vectors out, so what dies out are the higher branches of this one, of 9 times the eigenvalue and more.
  std::array<Vector, 2> x = elastic_waves(medium, sheet, F, K);
  const auto form = [&](const continuum::Sheet::Matrix &A, const Vector &a, const Vector &b)
  { return a * at_rest.weighted(A, b); };
  const auto quotient = [&](const Vector &y) { return form(stiffness, y, y) / form(at_rest.mass, y, y); };
  continuum::Sheet::Matrix shifted;
  sheet.make_matrix(sheet.conformity_constraints(), shifted);
  shifted.add(1., stiffness);
  shifted.add(0.1 * support::smallest_of({quotient(x[0]), quotient(x[1])}), at_rest.mass);
  continuum::DirectSolver solver;
  solver.factorise(shifted);
  for (Vector &y : x)
  {
    // Once: nodal values of the wave are off by the size of the interpolation error, of which the eigenvalue has the
    // square.
    solver.solve(y, at_rest.weighted(at_rest.mass, y));
    y *= 1. / y.linfty_norm();
    sheet.conformity_constraints().distribute(y);
  }
  // The errors of the eigenvalues in the space of the two vectors are the squares of those of the vectors.
  continuum::Sheet::Matrix damping;
  sheet.make_matrix(sheet.conformity_constraints(), damping);
  continuum::RateForces(sheet, medium.viscosity.get(), nullptr)
    .add_tangent(0., u, sheet.make_ghosted(), 1., sheet.conformity_constraints(), damping);
  Eigen::Matrix2d K2, C2, M2;
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t w = 0; w < 2; ++w)
    {
      K2(v, w) = form(stiffness, x[v], x[w]);
      C2(v, w) = form(damping, x[v], x[w]);
      M2(v, w) = form(at_rest.mass, x[v], x[w]);
    }
  if (!K2.allFinite() || !C2.allFinite() || !M2.allFinite())
    throw std::runtime_error("the finite elements have no waves: their tangent is not finite");
  // Unit mass: M = L L^T.
  const Eigen::Matrix2d inverse = Eigen::LLT<Eigen::Matrix2d>(M2).matrixL().solve(Eigen::Matrix2d::Identity());
  return bridge::plane_waves({inverse * K2 * inverse.transpose(), inverse * C2 * inverse.transpose()}, {1., 0.});
}

std::vector<Oscillation> finite_element_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                              const Eigen::Vector2d &K, const WaveMesh &mesh)
{
  // Both standing waves, released from rest.
  const auto run = [&](const Sampling &sampling)
  {
    MovingSheet moving(medium, K, mesh, settings_for(sampling.time_step, mesh, 1e-9));
    const WaveSheet at_rest(medium, moving.solver.sheet(), F);
    const std::array<Vector, 2> shapes = elastic_waves(medium, moving.solver.sheet(), F, K);
    // Newton's method sees the wave above the round-off of the forces in the stretched sheet.
    const double amplitude = element_strain / K.norm();
    Vector u = at_rest.base;
    u.add(amplitude, shapes[0], amplitude, shapes[1]);
    moving.solver.start(u, moving.solver.sheet().make_owned());
    constexpr std::size_t max_steps = 2000;
    return measure(moving, at_rest, {shapes[0], shapes[1]}, amplitude, sampling, max_steps);
  };
  // The error of average acceleration is (w h)^2 / 12 before extrapolation, which leaves some (w h)^4 / 300 of it.
  const double time_step = 2. * M_PI / 28. / bridge::fastest_frequency(continuum_waves(medium, F, K));
  return extrapolated({time_step, 1}, 1, run);
}

ElementWave element_wave(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                         const bridge::MemoryWave &wave, const WaveMesh &mesh)
{
  const double time_step = memory_step(medium, wave), rate = std::abs(wave.rate);
  double largest_imbalance = 0.; // of the last run
  const auto run = [&](const Sampling &sampling)
  {
    MovingSheet moving(medium, K, mesh, settings_for(sampling.time_step, mesh, 1e-10));
    continuum::DynamicSolver &solver = moving.solver;
    const continuum::Sheet &sheet = solver.sheet();
    const WaveSheet at_rest(medium, sheet, F);
    // At the phase of the wave, times `factor`, added to the homogeneous state or to nothing.
    const auto field = [&](const std::complex<double> &factor, bool is_on_base)
    {
      const Eigen::Vector2cd p = element_strain / K.norm() * factor * wave.polarisation;
      Vector nodal = interpolated(sheet, CosineWave(K, p.real()));
      if (is_on_base)
        nodal += at_rest.base;
      return nodal;
    };
    // Re(s tau / (1 + s tau) p) is the strain of the spring, so that a branch is relaxed at Re(p / (1 + s tau)).
    std::vector<Vector> relaxed;
    for (const double time : relaxation_times(*medium.memory))
      relaxed.push_back(field(1. / (1. + wave.rate * time), true));
    solver.start(field(1., true), field(wave.rate, false), relaxed);
    const double of_wave = solver.ledger().stored + solver.ledger().kinetic - energy(sheet, at_rest.base);
    support::LargestError imbalance;
    const Vector shape = interpolated(sheet, CosineWave(K, wave.polarisation.real().normalized()));
    const std::vector<Oscillation> found =
      measure(moving, at_rest, {shape}, element_strain / K.norm(), sampling, sampling.n_samples * sampling.stride,
              [&] { imbalance.add(std::abs(solver.ledger().imbalance) / of_wave); });
    largest_imbalance = imbalance.error();
    return found;
  };
  const Sampling sampling = sampling_of(wave.frequency(), wave.decay(), time_step, 25.);
  const Oscillation found = extrapolated(sampling, 2 * sampling.stride, run)[0];
  return {found, largest_imbalance,
          std::pow(rate * 0.5 * time_step, 2) / 6. * sampled_periods * 2. * M_PI * rate / wave.frequency()};
}

double sinusoidal_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                         const Eigen::Vector2d &p, double amplitude, const WaveMesh &resolution)
{
  const WaveRectangle of_wave(K, resolution.cells);
  const continuum::Sheet sheet(of_wave.mesh, medium.constitution, resolution.degree, periodic_edges());
  const Vector base = interpolated(sheet, bridge::AffineDisplacement(F)), shape = interpolated(sheet, CosineWave(K, p));
  const auto of_size = [&](double size)
  {
    Vector sum = base;
    sum.add(size, shape);
    return energy(sheet, sum);
  };
  return half_second_derivative(of_size, amplitude) / of_wave.area();
}

TravellingEnergy travelling_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                                   std::size_t wave, double amplitude, const WaveMesh &resolution)
{
  const bridge::PlaneWave found = continuum_waves(medium, F, K)[wave];
  constexpr int steps = 10;
  MovingSheet moving(medium, K, resolution, settings_for(0.25 * M_PI / found.frequency / steps, resolution, 1e-9));
  continuum::DynamicSolver &solver = moving.solver;
  const continuum::Sheet &sheet = solver.sheet();
  const Vector base = interpolated(sheet, bridge::AffineDisplacement(F));
  const double at_rest = energy(sheet, base);
  Vector u = base;
  u += interpolated(sheet, CosineWave(K, amplitude * found.polarisation));
  // cos(phase - pi/2) = sin(phase), the rate of cos(phase - w t) at t = 0 over w.
  solver.start(u, interpolated(sheet, CosineWave(K, amplitude * found.frequency * found.polarisation, 0.5 * M_PI)));
  for (int step = 0; step < steps; ++step)
    solver.step();
  const double area = moving.area();
  const continuum::EnergyLedger &ledger = solver.ledger();
  return {(ledger.stored - at_rest) / area, ledger.kinetic / area, ledger.micro_kinetic / area};
}

} // namespace latcon::claims
