#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

#include <cmath>

#include <Eigen/LU>

#include "verification/bridge/plane_waves.h"

namespace latcon::claims
{
namespace
{

// Stiffness of one shell of bonds against waves along N, over the mass of a site: D = A2 k^2 - A4 k^4 + ...
struct Series
{
  Eigen::Matrix2d A2 = Eigen::Matrix2d::Zero(); // [m^2/s^2]
  Eigen::Matrix2d A4 = Eigen::Matrix2d::Zero(); // [m^4/s^2]
};

std::array<Series, lattice::n_shells> series_by_shell(const lattice::TriangularLattice &lattice,
                                                      const lattice::Material &material, const Eigen::Matrix2d &F,
                                                      const Eigen::Vector2d &N)
{
  std::array<Series, lattice::n_shells> shells;
  const double mass = lattice::site_mass(material, lattice);
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d R = lattice.bond_vector(kind);
      const double length = lattice.rest_length(kind), stretch = (F * R).norm() / length, along = N.dot(R);
      const Eigen::Vector2d n = (F * R).normalized();
      const Eigen::Matrix2d H =
        lattice::cross_section(*shell, lattice) / length / mass *
        (lattice::stiffness(shell->law, stretch) * n * n.transpose() +
         lattice::force(shell->law, stretch) / stretch * (Eigen::Matrix2d::Identity() - n * n.transpose()));
      Series &series = shells[lattice::shell_of(kind)];
      series.A2 += std::pow(along, 2) * H;
      series.A4 += std::pow(along, 4) / 12. * H;
    }
  return shells;
}

} // namespace

Alpha lattice_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                    const Eigen::Matrix2d &F, const Eigen::Vector2d &N, Alpha *nearest_part)
{
  const std::array<Series, lattice::n_shells> shells = series_by_shell(lattice, material, F, N);
  Series all;
  for (const Series &shell : shells)
  {
    all.A2 += shell.A2;
    all.A4 += shell.A4;
  }
  const std::array<bridge::PlaneWave, 2> long_waves =
    bridge::plane_waves({all.A2, Eigen::Matrix2d::Zero()}, bridge::wave_normal(F, N));
  const double d2 = std::pow(lattice.spacing(), 2);
  Alpha alpha{};
  for (std::size_t w = 0; w < 2; ++w)
  {
    const Eigen::Vector2d &p = long_waves[w].polarisation;
    const double unit = std::pow(long_waves[w].frequency, 2) * d2;
    alpha[w] = p.dot(all.A4 * p) / unit;
    if (nearest_part != nullptr)
      (*nearest_part)[w] = p.dot(shells[0].A4 * p) / unit;
  }
  return alpha;
}

Alpha bloch_alpha(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Matrix2d &F, const Eigen::Vector2d &N)
{
  // With x = (kd)^2, w^2/x = c2 (1 - alpha x + beta x^2); three values give c2 and alpha, beta is in the way.
  const auto squares = [&](double kd) -> Eigen::Array2d
  {
    const auto waves = bridge::bloch_waves(lattice, material, F, kd / lattice.spacing() * N);
    return Eigen::Array2d(waves[0].frequency, waves[1].frequency).square() / (kd * kd);
  };
  constexpr double kd = 0.02;
  const Eigen::Array2d one = squares(kd), two = squares(2. * kd), four = squares(4. * kd);
  const double x = kd * kd;
  // Lagrange's interpolation at x, 4x, 16x: value and slope at 0.
  const Eigen::Array2d value = (64. * one - 20. * two + four) / 45.;
  const Eigen::Array2d slope = (-80. * one + 85. * two - 5. * four) / (180. * x);
  const Eigen::Array2d alpha = -slope / value;
  return {alpha[0], alpha[1]};
}

Alpha running_alpha(double spacing, lattice::Orientation orientation, const WaveDirection &direction,
                    const lattice::Material &material, const Eigen::Matrix2d &F)
{
  constexpr double lengths[] = {0.2, 0.4, 0.6, 0.8};
  Eigen::Matrix4d powers;
  Eigen::Matrix<double, 4, 2> squares;
  for (int i = 0; i < 4; ++i)
  {
    const WaveCell cell = wave_cell(spacing, orientation, direction, lengths[i]);
    const double x = std::pow(cell.K.norm() * spacing, 2);
    powers.row(i) << 1., x, x * x, x * x * x;
    const std::array<Oscillation, 2> waves = lattice_waves(cell, material, F);
    for (int w = 0; w < 2; ++w)
      squares(i, w) = std::pow(waves[static_cast<std::size_t>(w)].frequency, 2) / x;
  }
  const Eigen::Matrix<double, 4, 2> coefficients = powers.fullPivLu().solve(squares);
  return {-coefficients(1, 0) / coefficients(0, 0), -coefficients(1, 1) / coefficients(0, 1)};
}

Alpha continuum_alpha(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &N, double spacing)
{
  // (A2 k^2 + H k^4) / (1 + l_d^2 k^2): the matrices at two wave numbers are enough to tell A2 and H apart.
  const auto stiffness = [&](double kd)
  {
    const Eigen::Vector2d K = kd / spacing * N;
    const double inertia = 1. + std::pow(medium.inertia.length, 2) * K.squaredNorm();
    return Eigen::Matrix2d(continuum_matrices(medium, F, K).stiffness * inertia / (kd * kd));
  };
  const Eigen::Matrix2d one = stiffness(1.), two = stiffness(2.);
  const Eigen::Matrix2d H = (two - one) / 3., A2 = one - H;
  const std::array<bridge::PlaneWave, 2> long_waves =
    bridge::plane_waves({A2, Eigen::Matrix2d::Zero()}, bridge::wave_normal(F, N));
  Alpha alpha{};
  for (std::size_t w = 0; w < 2; ++w)
  {
    const Eigen::Vector2d &p = long_waves[w].polarisation;
    alpha[w] = std::pow(medium.inertia.length / spacing, 2) - p.dot(H * p) / p.dot(A2 * p);
  }
  return alpha;
}

} // namespace latcon::claims
