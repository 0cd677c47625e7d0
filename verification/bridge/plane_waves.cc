#include "verification/bridge/plane_waves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <variant>

#include <Eigen/LU>

#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/small_strain.h"

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

// Modes exp(s t) of a sheet, with s in `rate`: those with w > 0 first, and of two that do not oscillate the slower.
std::vector<MemoryWave> free_modes(const WaveMatrices &relaxed, const std::vector<BranchMatrix> &branches)
{
  // (u, u'/r, r_1, r_2, ...)' = r B (...) with the forces r_i' = G_i u' - r_i / tau_i per mass and r^2, and a rate r
  // that scales the entries to similar size.
  double squared_rate = relaxed.stiffness.norm();
  for (const BranchMatrix &branch : branches)
    squared_rate += branch.stiffness.norm();
  const double rate = std::sqrt(squared_rate);
  const auto size = static_cast<Eigen::Index>(4 + 2 * branches.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(size, size);
  B.block<2, 2>(0, 2).setIdentity();
  B.block<2, 2>(2, 0) = -relaxed.stiffness / (rate * rate);
  B.block<2, 2>(2, 2) = -relaxed.damping / rate;
  Eigen::Index at = 4;
  for (const BranchMatrix &branch : branches)
  {
    B.block<2, 2>(2, at) = -Eigen::Matrix2d::Identity();
    B.block<2, 2>(at, 2) = branch.stiffness / (rate * rate);
    B.block<2, 2>(at, at) = -Eigen::Matrix2d::Identity() / (rate * branch.relaxation_time);
    at += 2;
  }
  // The solver of eigenvalues does not handle values that are not finite.
  if (!B.allFinite())
    throw std::runtime_error("the stiffness of a sheet is not finite");
  const support::ComplexModes modes = support::complex_modes(B);
  std::vector<MemoryWave> waves;
  for (Eigen::Index i = 0; i < size; ++i)
  {
    const Eigen::Vector2cd p = modes.vectors.col(i).head<2>();
    waves.push_back({rate * modes.values[i], p / (std::abs(p[0]) > std::abs(p[1]) ? p[0] : p[1])});
  }
  std::stable_sort(waves.begin(), waves.end(),
                   [](const MemoryWave &a, const MemoryWave &b) {
                     return a.rate.imag() != b.rate.imag() ? a.rate.imag() > b.rate.imag()
                                                           : a.rate.real() > b.rate.real();
                   });
  return waves;
}

std::array<PlaneWave, 2> damped(const WaveMatrices &matrices)
{
  const std::vector<MemoryWave> modes = free_modes(matrices, {});
  // Polarisations are real up to a phase if damping and stiffness have the same axes, nearly so otherwise.
  const auto wave = [](const MemoryWave &mode) {
    return PlaneWave{support::one_sided(mode.frequency()), mode.decay(), mode.polarisation.real().normalized()};
  };
  return {wave(modes[0]), wave(modes[1])};
}

// The corners of the hexagonal zone are at kd = 4 pi / 3; all reciprocal vectors, where w = 0 again, are longer.
constexpr double shortest = 0.01, longest = 4. * M_PI / 3.;
constexpr int n_angles = 120, n_lengths = 60;
constexpr double angle_step = M_PI / n_angles, length_step = (longest - shortest) / n_lengths;

} // namespace

std::array<PlaneWave, 2> plane_waves(const WaveMatrices &matrices, const Eigen::Vector2d &longitudinal)
{
  // The eigenvalue solvers do not handle values that are not finite.
  if (!matrices.stiffness.allFinite() || !matrices.damping.allFinite())
    return {PlaneWave{not_a_number, not_a_number, {not_a_number, not_a_number}},
            PlaneWave{not_a_number, not_a_number, {not_a_number, not_a_number}}};
  std::array<PlaneWave, 2> waves = matrices.damping.isZero(0.) ? undamped(matrices.stiffness) : damped(matrices);
  if (std::abs(waves[0].polarisation.dot(longitudinal)) < std::abs(waves[1].polarisation.dot(longitudinal)))
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

WaveMatrices bloch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                            const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  WaveMatrices matrices{Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Zero()};
  const double mass = lattice::site_mass(material, lattice);
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
  {
    const lattice::Shell *shell = material.shell(lattice, kind);
    if (shell == nullptr)
      continue;
    const Eigen::Vector2d R = lattice.bond_vector(kind);
    const double length = lattice.rest_length(kind);
    const Eigen::Vector2d n = (F * R).normalized();
    // 2 (1 - cos K.R) of both ends of the bond, in a form without cancellation for long waves.
    const double phase = 4. * std::pow(std::sin(0.5 * K.dot(R)), 2);
    const double factor = phase * lattice::cross_section(*shell, lattice, kind) / length / mass;
    matrices.stiffness += factor * bond_tangent(shell->law, F * R / length);
    matrices.damping += factor * shell->viscosity * n * n.transpose();
  }
  return matrices;
}

std::array<PlaneWave, 2> bloch_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  const lattice::Material springs = lattice::without_dashpots(material);
  return named_waves([&](const Eigen::Vector2d &k) { return bloch_matrices(lattice, springs, F, k); }, F, K);
}

SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F)
{
  // Smaller of the two w^2 / k^2 at a wave vector in polar coordinates; lengths k d beyond the ends of the grid are
  // moved there.
  const auto at = [&](double angle, double kd) -> SlowestWave
  {
    const double length = kd < shortest ? shortest : kd > longest ? longest : kd;
    const Eigen::Vector2d K = length / lattice.spacing() * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    return {support::symmetric_eigenvalues(bloch_matrices(lattice, material, F, K).stiffness)[0] / K.squaredNorm(), K};
  };
  // Descends from a point of the grid in ever smaller steps along and across K.
  const auto descend = [&](double angle, double kd)
  {
    SlowestWave slowest = at(angle, kd);
    for (double step = 0.5; step > 1e-6;)
    {
      bool is_lower = false;
      for (const auto &[turns, lengthens] : {std::array{1., 0.}, {-1., 0.}, {0., 1.}, {0., -1.}})
      {
        const double to = angle + turns * step * angle_step, length = kd + lengthens * step * length_step;
        if (const SlowestWave found = at(to, length); found.squared_speed < slowest.squared_speed)
        {
          slowest = found;
          angle = to;
          kd = length;
          is_lower = true;
        }
      }
      if (!is_lower)
        step /= 2.;
    }
    return slowest;
  };
  std::array<std::array<double, n_lengths + 1>, n_angles> grid{};
  for (int i = 0; i < n_angles; ++i)
    for (int j = 0; j <= n_lengths; ++j)
    {
      const SlowestWave found = at(i * angle_step, shortest + j * length_step);
      if (!std::isfinite(found.squared_speed))
        return found;
      grid[i][j] = found.squared_speed;
    }
  // From each minimum of the grid, since that closest to the smallest value need not be its lowest.
  SlowestWave slowest{std::numeric_limits<double>::infinity(), Eigen::Vector2d::Zero()};
  for (int i = 0; i < n_angles; ++i)
    for (int j = 0; j <= n_lengths; ++j)
    {
      bool is_minimum = true;
      for (int a = -1; a <= 1; ++a) // K and -K are the same wave
        for (int b = j > 0 ? -1 : 0; b <= (j < n_lengths ? 1 : 0); ++b)
          is_minimum = is_minimum && grid[i][j] <= grid[(i + a + n_angles) % n_angles][j + b];
      if (!is_minimum)
        continue;
      if (const SlowestWave found = descend(i * angle_step, shortest + j * length_step);
          found.squared_speed < slowest.squared_speed)
        slowest = found;
    }
  return slowest;
}

std::vector<BranchMatrix> branch_matrices(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                          const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  std::vector<BranchMatrix> branches;
  const double mass = lattice::site_mass(material, lattice);
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
  {
    const lattice::Shell *shell = material.in_shell(number);
    if (shell != nullptr && std::holds_alternative<lattice::CustomMemory>(shell->memory))
      throw std::invalid_argument("waves in bonds with a custom memory have no closed form");
    const auto *memory = shell != nullptr ? std::get_if<lattice::MaxwellMemory>(&shell->memory) : nullptr;
    if (memory == nullptr)
      continue;
    // Per unit of the modulus.
    Eigen::Matrix2d stiffness = Eigen::Matrix2d::Zero();
    for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
      if (lattice::shell_of(kind) == number)
      {
        const Eigen::Vector2d R = lattice.bond_vector(kind), n = (F * R).normalized();
        const double phase = 4. * std::pow(std::sin(0.5 * K.dot(R)), 2);
        stiffness +=
          phase * lattice::cross_section(*shell, lattice) / lattice.rest_length(kind) / mass * n * n.transpose();
      }
    for (const lattice::MaxwellMemory::Branch &branch : memory->branches())
      branches.push_back({branch.modulus * stiffness, branch.relaxation_time});
  }
  return branches;
}

std::array<MemoryWave, 2> memory_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                       const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  return memory_waves(bloch_matrices(lattice, material, F, K), branch_matrices(lattice, material, F, K),
                      wave_normal(F, K));
}

std::array<MemoryWave, 2> memory_waves(const WaveMatrices &relaxed, const std::vector<BranchMatrix> &branches,
                                       const Eigen::Vector2d &normal)
{
  const std::vector<MemoryWave> modes = free_modes(relaxed, branches);
  std::array<MemoryWave, 2> waves{modes[0], modes[1]};
  for (MemoryWave &wave : waves)
    if (!(wave.frequency() > 0.)) // some mode that relaxes
      wave = {{not_a_number, not_a_number},
              Eigen::Vector2cd::Constant(std::complex<double>(not_a_number, not_a_number))};
  const auto along = [&](const MemoryWave &w)
  { return std::abs(w.polarisation.dot(normal.cast<std::complex<double>>())) / w.polarisation.norm(); };
  const double along_first = along(waves[0]), along_second = along(waves[1]);
  if (along_first < (std::isnan(along_second) ? std::sqrt(0.5) : along_second))
    std::swap(waves[0], waves[1]);
  return waves;
}

} // namespace latcon::bridge
