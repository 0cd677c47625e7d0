#include "verification/bridge/slowest_wave.h"

#include <array>
#include <cmath>
#include <limits>

#include "support/dense.h"
#include "verification/bridge/plane_waves.h"

namespace latcon::bridge
{
namespace
{

// The corners of the hexagonal zone are at kd = 4 pi / 3; all reciprocal vectors, where w = 0 again, are longer.
constexpr double shortest = 0.01, longest = 4. * M_PI / 3.;
constexpr int n_angles = 120, n_lengths = 60;
constexpr double angle_step = M_PI / n_angles, length_step = (longest - shortest) / n_lengths;

} // namespace

SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F)
{
  // Smaller of the two w^2 / k^2 at a wave vector in polar coordinates; lengths k d beyond the ends of the grid are moved
  // there.
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

} // namespace latcon::bridge
