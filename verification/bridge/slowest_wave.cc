#include "verification/bridge/slowest_wave.h"

#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include "verification/bridge/bloch.h"

namespace latcon::bridge
{

SlowestWave slowest_wave(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         const Eigen::Matrix2d &F)
{
  // The corners of the hexagonal zone are at kd = 4 pi / 3; all reciprocal vectors, where w = 0 again, are longer.
  constexpr double shortest = 0.01, largest = 4. * M_PI / 3.;
  constexpr int n_angles = 120, n_lengths = 60;
  SlowestWave slowest{std::numeric_limits<double>::infinity(), Eigen::Vector2d::Zero()};
  for (int i = 0; i < n_angles; ++i)
  {
    const double angle = M_PI * i / n_angles; // K and -K are the same wave
    const Eigen::Vector2d N(std::cos(angle), std::sin(angle));
    for (int j = 0; j <= n_lengths; ++j)
    {
      const Eigen::Vector2d K = (shortest + (largest - shortest) * j / n_lengths) / lattice.spacing() * N;
      const double smallest =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(bloch_matrices(lattice, material, F, K).stiffness)
          .eigenvalues()[0] /
        K.squaredNorm();
      if (!std::isfinite(smallest))
        return {smallest, K};
      if (smallest < slowest.squared_speed)
        slowest = {smallest, K};
    }
  }
  return slowest;
}

} // namespace latcon::bridge
