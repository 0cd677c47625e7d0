#pragma once

#include <vector>

#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/subject.h"

namespace latcon::claims
{

/// The simulator on a sheet of 12 by 12 spacings of the lattice with the half-bonds of a nonlocal continuum, without
/// dashpots.
class StencilSheet
{
public:
  StencilSheet(const bridge::Subject &subject, const lattice::Grid &grid, std::vector<lattice::HalfBond> half_bonds);

  const std::vector<lattice::HalfBond> &half_bonds() const { return half_bonds_; }

  bridge::LatticeResponse response(const Eigen::Matrix2d &F) const
  {
    return bridge::homogeneous_response(sheet_, material_, F);
  }

  /// Stiffness of plane waves [1/s^2], that of bridge::WaveMatrices, from the force on a site in the crest of a wave with
  /// a strain of 1e-5. @param K referential wave vector [1/m]
  Eigen::Matrix2d wave_stiffness(const Eigen::Matrix2d &F, const Eigen::Vector2d &K) const;

  /// A cut along x between two rows, through bonds that all have one stretch.
  struct Cut
  {
    double energy; ///< taken from the sheet, per area [J/m^2]
    double tip;    ///< X of the tip that fracture finds, from the end of the cut [m]
    double period; ///< of the points of the grid along x [m]
  };
  Cut cut(double stretch) const;

  /// First Piola stress [Pa] of the held sheet after this many time steps, in which nothing moves and Maxwell branches
  /// relax. They are unloaded before the deformation to F, which is sudden. @param step [s], a stable one
  Eigen::Matrix2d relaxed_stress(const lattice::Material &material, const Eigen::Matrix2d &F, double step,
                                 std::size_t n_steps) const;

  const lattice::TriangularLattice &sheet() const { return sheet_; }

private:
  lattice::Material material_;
  std::vector<lattice::HalfBond> half_bonds_;
  lattice::TriangularLattice sheet_;
};

} // namespace latcon::claims
