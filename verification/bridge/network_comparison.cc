#include "verification/bridge/network_comparison.h"

#include "verification/bridge/homogeneous_response.h"

namespace latcon::bridge
{

NetworkComparison::NetworkComparison(const Subject &subject, const lattice::TriangularLattice &sheet,
                                     const Eigen::Matrix2d &F)
  : network_energy(subject.network.energy(to_continuum(F))),
    network_stress(to_lattice(subject.network.first_piola_stress(to_continuum(F))))
{
  Eigen::MatrixXd energies(1, n_lattice_rotations), stresses(4, n_lattice_rotations);
  for (int k = 0; k < n_lattice_rotations; ++k)
  {
    const Eigen::Matrix2d R = lattice_rotation(k);
    const LatticeResponse response = homogeneous_response(sheet, subject.material, F * R);
    const Eigen::Matrix2d rotated_stress = response.first_piola_stress * R.transpose();
    energies(0, k) = response.energy_density;
    stresses.col(k) = rotated_stress.reshaped();
    if (k == 0)
    {
      lattice_energy = response.energy_density;
      lattice_stress = rotated_stress;
    }
  }
  energy = rotation_mean(energies);
  stress = rotation_mean(stresses);
}

} // namespace latcon::bridge
