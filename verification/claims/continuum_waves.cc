#include "verification/claims/continuum_waves.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/affine_displacement.h"
#include "verification/bridge/homogenisation.h"
#include "verification/claims/wave_sheet.h"

namespace latcon::claims
{
namespace
{

using Vector = continuum::Sheet::Vector;

// A sheet with its mass matrix, and both waves on it.
class WaveSheet
{
public:
  WaveSheet(const WaveContinuum &medium, const continuum::Sheet &sheet, const Eigen::Matrix2d &F,
            const Eigen::Vector2d &K)
    : sheet_(sheet), waves_(bridge::plane_waves(elastic(continuum_matrices(medium, F, K)), bridge::wave_normal(F, K)))
  {
    sheet.make_matrix(sheet.conformity_constraints(), mass_);
    sheet.mass(medium.inertia.density, medium.inertia.length, sheet.conformity_constraints(), mass_);
    base_ = interpolated(sheet, bridge::AffineDisplacement(F));
    for (std::size_t w = 0; w < 2; ++w)
      shapes_[w] = interpolated(sheet, CosineWave(K, waves_[w].polarisation));
  }

  const continuum::Sheet::Matrix &mass() const { return mass_; }
  const Vector &base() const { return base_; } ///< displacement of the homogeneous state [m]
  const Vector &shape(std::size_t w) const { return shapes_[w]; }
  const bridge::PlaneWave &wave(std::size_t w) const { return waves_[w]; }

  /// x.A y over the independent unknowns.
  double form(const continuum::Sheet::Matrix &A, const Vector &x, const Vector &y) const
  {
    Vector product = sheet_.make_owned();
    A.vmult(product, y);
    double sum = 0.;
    for (const auto i : sheet_.owned())
      if (!sheet_.conformity_constraints().is_constrained(i))
        sum += x(i) * product(i);
    return sum;
  }

  /// Clears the rows of dependent unknowns; the prescribed values are zero.
  void clear_dependent(Vector &b) const
  {
    for (const auto i : sheet_.owned())
      if (sheet_.conformity_constraints().is_constrained(i))
        b(i) = 0.;
    b.compress(dealii::VectorOperation::insert);
  }

private:
  static bridge::WaveMatrices elastic(bridge::WaveMatrices matrices)
  {
    matrices.damping.setZero();
    return matrices;
  }

  const continuum::Sheet &sheet_;
  std::array<bridge::PlaneWave, 2> waves_;
  continuum::Sheet::Matrix mass_;
  Vector base_;
  std::array<Vector, 2> shapes_;
};

std::array<Oscillation, 2> measure(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                                   const WaveMesh &resolution, double time_step)
{
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, one_wavelength(K, resolution.cells));
  continuum::DynamicSettings settings;
  settings.time_step = time_step;
  settings.degree = resolution.degree;
  settings.relative_tolerance = 1e-9;
  continuum::DynamicSolver solver(mesh, medium.constitution, periodic_edges(), medium.inertia, settings,
                                  medium.viscosity);
  const continuum::Sheet &sheet = solver.sheet();
  const WaveSheet wave_sheet(medium, sheet, F, K);

  // Nonlinear terms change frequencies by the square of this strain; Newton's method sees the wave above the round-off
  // of the forces in the stretched sheet.
  const double amplitude = 1e-4 / K.norm();
  Vector u = wave_sheet.base();
  u.add(amplitude, wave_sheet.shape(0), amplitude, wave_sheet.shape(1));
  solver.start(u, sheet.make_owned());

  std::array<std::vector<double>, 2> amplitudes;
  std::array<unsigned int, 2> sign_changes{};
  Vector difference = sheet.make_owned();
  const auto observe = [&]
  {
    difference = solver.displacement();
    difference -= wave_sheet.base();
    for (std::size_t w = 0; w < 2; ++w)
    {
      const Vector &shape = wave_sheet.shape(w);
      const double value = wave_sheet.form(wave_sheet.mass(), shape, difference) /
                           (amplitude * wave_sheet.form(wave_sheet.mass(), shape, shape));
      if (!std::isfinite(value))
        throw std::runtime_error("a wave has an amplitude that is not finite");
      if (!amplitudes[w].empty() && value * amplitudes[w].back() < 0.)
        ++sign_changes[w];
      amplitudes[w].push_back(value);
    }
  };
  observe();
  constexpr std::size_t max_steps = 2000;
  for (std::size_t step = 0; std::min<unsigned int>(sign_changes[0], sign_changes[1]) < 2; ++step)
  {
    if (step == max_steps)
      throw std::runtime_error("a wave of the finite element sheet did not oscillate: it is overdamped, or unstable");
    solver.step();
    observe();
  }
  return {fit_oscillation(amplitudes[0], time_step), fit_oscillation(amplitudes[1], time_step)};
}

} // namespace

bridge::WaveMatrices continuum_matrices(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  const dealii::Tensor<2, 2> state = bridge::to_continuum(F);
  const dealii::Tensor<4, 2> T = medium.constitution.local->tangent(state);
  dealii::Tensor<6, 2> C;
  if (medium.constitution.gradient != nullptr)
    C = medium.constitution.gradient->double_stress_by_G(state);
  dealii::Tensor<4, 2> viscous;
  if (medium.viscosity != nullptr)
    viscous = medium.viscosity->stress_by_rate(state, dealii::Tensor<2, 2>());
  bridge::WaveMatrices matrices{Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int k = 0; k < 2; ++k)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int L = 0; L < 2; ++L)
        {
          matrices.stiffness(i, k) += T[i][J][k][L] * K[J] * K[L];
          matrices.damping(i, k) += viscous[i][J][k][L] * K[J] * K[L];
          for (unsigned int M = 0; M < 2; ++M)
            for (unsigned int N = 0; N < 2; ++N)
              matrices.stiffness(i, k) += C[i][J][L][k][M][N] * K[J] * K[L] * K[M] * K[N];
        }
  const double mass = medium.inertia.density * (1. + medium.inertia.length * medium.inertia.length * K.squaredNorm());
  matrices.stiffness /= mass;
  matrices.damping /= mass;
  return matrices;
}

double discretisation_bound(const WaveMesh &mesh)
{
  const double p = mesh.degree - 1., kh = 2. * M_PI / mesh.cells;
  return std::pow(std::tgamma(p + 1.) / std::tgamma(2. * p + 1.), 2) * std::pow(kh, 2. * p) / (4. * p + 2.);
}

std::array<double, 2> discrete_frequencies(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                           const Eigen::Vector2d &K, const WaveMesh &resolution)
{
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  continuum::make_rectangle(mesh, one_wavelength(K, resolution.cells));
  const continuum::Sheet sheet(mesh, medium.constitution, resolution.degree, periodic_edges());
  const WaveSheet wave_sheet(medium, sheet, F, K);
  Vector u = sheet.make_ghosted();
  u = wave_sheet.base();
  continuum::Sheet::Matrix stiffness;
  sheet.make_matrix(sheet.conformity_constraints(), stiffness);
  sheet.tangent(u, sheet.conformity_constraints(), stiffness);
  continuum::LinearSolver solver(sheet, {}, {});

  // Both waves at once, by inverse iteration with a shift below them. Translations by whole cells keep waves of other
  // wave vectors out, so what dies out are the higher branches of this one, of 9 times the eigenvalue and more.
  std::array<Vector, 2> x{wave_sheet.shape(0), wave_sheet.shape(1)};
  const auto quotient = [&](std::size_t w)
  { return wave_sheet.form(stiffness, x[w], x[w]) / wave_sheet.form(wave_sheet.mass(), x[w], x[w]); };
  continuum::Sheet::Matrix shifted;
  sheet.make_matrix(sheet.conformity_constraints(), shifted);
  shifted.add(1., stiffness);
  shifted.add(0.1 * support::smallest_of({quotient(0), quotient(1)}), wave_sheet.mass());
  Vector b = sheet.make_owned();
  for (Vector &y : x)
  {
    // Once: nodal values of the wave are off by the size of the interpolation error, of which the eigenvalue has the
    // square.
    wave_sheet.mass().vmult(b, y);
    wave_sheet.clear_dependent(b);
    solver.solve(shifted, y, b);
    y *= 1. / y.linfty_norm();
    sheet.conformity_constraints().distribute(y);
  }
  // The errors of the eigenvalues in the space of the two vectors are the squares of those of the vectors.
  Eigen::Matrix2d K2, M2;
  for (std::size_t v = 0; v < 2; ++v)
    for (std::size_t w = 0; w < 2; ++w)
    {
      K2(v, w) = wave_sheet.form(stiffness, x[v], x[w]);
      M2(v, w) = wave_sheet.form(wave_sheet.mass(), x[v], x[w]);
    }
  if (!K2.allFinite() || !M2.allFinite())
    throw std::runtime_error("the finite elements have no waves: their tangent is not finite");
  const support::SymmetricModes ritz = support::symmetric_modes(K2, M2);
  const auto frequency = [&](int i) { return std::sqrt(support::one_sided(ritz.values[i])); };
  const bool first_is_longitudinal =
    std::abs(ritz.vectors(0, 0)) * std::sqrt(M2(0, 0)) > std::abs(ritz.vectors(1, 0)) * std::sqrt(M2(1, 1));
  return {frequency(first_is_longitudinal ? 0 : 1), frequency(first_is_longitudinal ? 1 : 0)};
}

std::array<Oscillation, 2> finite_element_waves(const WaveContinuum &medium, const Eigen::Matrix2d &F,
                                                const Eigen::Vector2d &K, const WaveMesh &mesh)
{
  const std::array<bridge::PlaneWave, 2> waves =
    bridge::plane_waves(continuum_matrices(medium, F, K), bridge::wave_normal(F, K));
  // The error of average acceleration is (w h)^2 / 12 before extrapolation, which leaves some (w h)^4 / 300 of it.
  const double time_step = 2. * M_PI / 28. / bridge::fastest_frequency(waves);
  const std::array<Oscillation, 2> coarse = measure(medium, F, K, mesh, time_step);
  std::array<Oscillation, 2> result = measure(medium, F, K, mesh, 0.5 * time_step);
  for (std::size_t w = 0; w < 2; ++w)
  {
    result[w].frequency += (result[w].frequency - coarse[w].frequency) / 3.;
    result[w].decay += (result[w].decay - coarse[w].decay) / 3.;
  }
  return result;
}

double sinusoidal_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                         const Eigen::Vector2d &p, double amplitude, const WaveMesh &resolution)
{
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  const continuum::Rectangle rectangle = one_wavelength(K, resolution.cells);
  continuum::make_rectangle(mesh, rectangle);
  const continuum::Sheet sheet(mesh, medium.constitution, resolution.degree, periodic_edges());
  const Vector base = interpolated(sheet, bridge::AffineDisplacement(F)), shape = interpolated(sheet, CosineWave(K, p));
  Vector u = sheet.make_ghosted(), sum = sheet.make_owned();
  const auto energy = [&](double size)
  {
    sum = base;
    sum.add(size, shape);
    u = sum;
    return sheet.energy(u);
  };
  const double at_rest = energy(0.);
  const auto second = [&](double size) { return 0.5 * (energy(size) + energy(-size) - 2. * at_rest) / (size * size); };
  return (4. * second(amplitude) - second(2. * amplitude)) / 3. / (rectangle.length * rectangle.height);
}

TravellingEnergy travelling_energy(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                                   std::size_t wave, double amplitude, const WaveMesh &resolution)
{
  continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
  const continuum::Rectangle rectangle = one_wavelength(K, resolution.cells);
  continuum::make_rectangle(mesh, rectangle);
  const bridge::PlaneWave found =
    bridge::plane_waves(continuum_matrices(medium, F, K), bridge::wave_normal(F, K))[wave];
  constexpr int steps = 10;
  continuum::DynamicSettings settings;
  settings.time_step = 0.25 * M_PI / found.frequency / steps;
  settings.degree = resolution.degree;
  settings.relative_tolerance = 1e-9;
  continuum::DynamicSolver solver(mesh, medium.constitution, periodic_edges(), medium.inertia, settings);
  const continuum::Sheet &sheet = solver.sheet();
  const Vector base = interpolated(sheet, bridge::AffineDisplacement(F));
  Vector ghosted = sheet.make_ghosted();
  ghosted = base;
  const double at_rest = sheet.energy(ghosted);
  Vector u = base;
  u += interpolated(sheet, CosineWave(K, amplitude * found.polarisation));
  // cos(phase - pi/2) = sin(phase), the rate of cos(phase - w t) at t = 0 over w.
  solver.start(u, interpolated(sheet, CosineWave(K, amplitude * found.frequency * found.polarisation, 0.5 * M_PI)));
  for (int step = 0; step < steps; ++step)
    solver.step();
  const double area = rectangle.length * rectangle.height;
  const continuum::EnergyLedger &ledger = solver.ledger();
  return {(ledger.stored - at_rest) / area, ledger.kinetic / area, ledger.micro_kinetic / area};
}

} // namespace latcon::claims
