#include "verification/bridge/bloch.h"

#include <cmath>

namespace latcon::bridge
{

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
    const double stretch = (F * R).norm() / length;
    const Eigen::Vector2d n = (F * R).normalized();
    const Eigen::Matrix2d along = n * n.transpose();
    const double section_over_length = lattice::cross_section(*shell, lattice, kind) / length;
    // 2 (1 - cos K.R) of both ends of the bond, in a form without cancellation for long waves.
    const double phase = 4. * std::pow(std::sin(0.5 * K.dot(R)), 2);
    matrices.stiffness += phase * section_over_length / mass *
                          (lattice::stiffness(shell->law, stretch) * along +
                           lattice::force(shell->law, stretch) / stretch * (Eigen::Matrix2d::Identity() - along));
    matrices.damping += phase * section_over_length / mass * shell->viscosity * along;
  }
  return matrices;
}

std::array<PlaneWave, 2> bloch_waves(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                     const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  WaveMatrices matrices = bloch_matrices(lattice, material, F, K);
  matrices.damping.setZero();
  return plane_waves(matrices, wave_normal(F, K));
}

} // namespace latcon::bridge
