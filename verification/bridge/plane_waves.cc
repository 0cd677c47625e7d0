#include "verification/bridge/plane_waves.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>

#include "support/dense.h"
#include "support/largest_error.h"

namespace latcon::bridge
{
namespace
{

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Waves without dashpots: the problem is symmetric, so its eigenvectors are orthogonal to round-off.
std::array<PlaneWave, 2> undamped(const Eigen::Matrix2d &stiffness)
{
  const support::SymmetricModes modes = support::symmetric_modes(stiffness);
  const auto wave = [&](int i) {
    return PlaneWave{std::sqrt(support::one_sided(modes.values[i])), 0., modes.vectors.col(i)};
  };
  return {wave(0), wave(1)};
}

std::array<PlaneWave, 2> damped(const WaveMatrices &matrices)
{
  // (u, u'/s)' = s B (u, u'/s) with a rate s that scales the entries to similar size.
  const double rate = std::sqrt(matrices.stiffness.norm());
  Eigen::Matrix4d B;
  B << Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity(), -matrices.stiffness / (rate * rate),
    -matrices.damping / rate;
  const support::ComplexModes modes = support::complex_modes(B);
  // Select from each conjugate pair the eigenvalue with positive frequency, and from two real ones (an overdamped wave)
  // the slower.
  std::array<int, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(),
            [&](int a, int b)
            {
              const std::complex<double> va = modes.values[a], vb = modes.values[b];
              return va.imag() != vb.imag() ? va.imag() > vb.imag() : va.real() > vb.real();
            });
  const auto wave = [&](int i)
  {
    const std::complex<double> value = rate * modes.values[i];
    const Eigen::Vector2cd vector = modes.vectors.col(i).head<2>();
    // Real up to a phase if damping and stiffness have the same axes, nearly so otherwise.
    const std::complex<double> largest = std::abs(vector[0]) > std::abs(vector[1]) ? vector[0] : vector[1];
    return PlaneWave{support::one_sided(value.imag()), -value.real(),
                     Eigen::Vector2d((vector / largest).real()).normalized()};
  };
  return {wave(order[0]), wave(order[1])};
}

} // namespace

std::array<PlaneWave, 2> plane_waves(const WaveMatrices &matrices, const Eigen::Vector2d &normal)
{
  // The eigenvalue solvers do not handle values that are not finite.
  if (!matrices.stiffness.allFinite() || !matrices.damping.allFinite())
    return {PlaneWave{not_a_number, not_a_number, {not_a_number, not_a_number}},
            PlaneWave{not_a_number, not_a_number, {not_a_number, not_a_number}}};
  std::array<PlaneWave, 2> waves = matrices.damping.isZero(0.) ? undamped(matrices.stiffness) : damped(matrices);
  if (std::abs(waves[0].polarisation.dot(normal)) < std::abs(waves[1].polarisation.dot(normal)))
    std::swap(waves[0], waves[1]);
  return waves;
}

double fastest_frequency(const std::array<PlaneWave, 2> &waves)
{
  for (const PlaneWave &wave : waves)
    if (!std::isfinite(wave.frequency) || !(wave.frequency > 0.))
      throw std::runtime_error("a wave does not oscillate: it is overdamped, or the sheet is unstable");
  return support::largest_of({waves[0].frequency, waves[1].frequency});
}

Eigen::Vector2d wave_normal(const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  return (F.inverse().transpose() * K).normalized();
}

} // namespace latcon::bridge
