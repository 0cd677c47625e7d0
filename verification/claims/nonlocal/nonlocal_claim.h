#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lattice/state.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"
#include "verification/claims/spectrum.h"

namespace latcon::claims
{

/// Grid and rings of a nonlocal continuum.
struct NonlocalStencil
{
  std::string name; ///< in rows: "square grid, m = 2"
  lattice::Grid grid;
  double half_width = M_PI / 6.; ///< of the arcs of its rings [rad]
  bool is_of_case = true;        ///< must be accurate in the loaded sheet, others only where their bound is below 0.1
};

/// Options of the claim.
struct NonlocalOptions
{
  /// Each has the rows of homogeneous deformations and waves, grids also of length and cut.
  std::vector<NonlocalStencil> stencils;
  unsigned int samples = 20;             ///< random F
  double breaking_stretch = 3.;          ///< lam_f [-]
  /// Changes of rings and of half-bonds by which tests plant faults; none by default.
  std::function<void(std::vector<lattice::Ring> &)> planted_rings = [](auto &) {};
  std::function<void(std::vector<lattice::HalfBond> &)> planted_bonds = [](auto &) {};
  double planted_tip = 0.; ///< added to the tip of the cut [m], as of a rule that finds another one
  PlantedBranches planted_branches = [](const lattice::Material &material) { return material; };
  /// Changes of the factors of bonds between scattered points, likewise.
  std::function<void(lattice::BondFactors &, const lattice::TriangularLattice &)> planted_factors = [](auto &, auto &) {
  };
};

/// Square and triangular grids for m = 1.5, 2 and 3, and scattered points of a square one for m = 1.5 and of a
/// triangular one for m = 2, with the third shell 1.5; bonds in all directions.
std::vector<NonlocalStencil> fixed_stencils(const bridge::Subject &subject);

/// Claim `nonlocal`: the nonlocal continuum, bonds of the lattice's lengths in all directions on a grid or between
/// scattered points, has the moduli of the network law and the mean over rotations of the lattice, up to what its grid
/// leaves; and converges to both with the spacing h = d/m of the grid (theory-comparison.md, eqs. (H.25) to (H.30)).
/// At rest, Maxwell branches relax as the network's, and the tip of a cut is at its end.
///
/// Energies, stresses, waves and the energy of a cut are those of the simulator on a sheet with the stencil. Every rank
/// computes all of it.
output::Results nonlocal_claim(const bridge::Subject &subject, const NonlocalOptions &options);

/// Returns the half-bonds of rings on a grid, with the faults that tests plant.
std::vector<lattice::HalfBond> planted_bonds(const bridge::Subject &subject, const lattice::Grid &grid,
                                             const NonlocalOptions &options, double half_width = M_PI / 6.);

/// Rows of the claim `nonlocal` on the orders in 1/m with which rings in all directions converge to the network and to
/// the lattice's mean over rotations.
void ring_convergence(const bridge::Subject &subject, const NonlocalOptions &options, const Rows &rows);

/// The simulator on a sheet of 12 by 12 spacings of the lattice with the half-bonds of a nonlocal continuum, without
/// dashpots. Scattered points have one of 24 by 24 spacings without edges, and means over all points.
class StencilSheet
{
public:
  using Planted = std::function<void(lattice::BondFactors &, const lattice::TriangularLattice &)>;

  /// @param planted changes of the factors of bonds between scattered points
  StencilSheet(const bridge::Subject &subject, const lattice::Grid &grid, std::vector<lattice::HalfBond> half_bonds,
               Planted planted);

  const std::vector<lattice::HalfBond> &half_bonds() const { return half_bonds_; }

  bridge::LatticeResponse response(const Eigen::Matrix2d &F) const;

  /// Returns K, or the nearest vector of a wave [1/m] that a sheet without edges can have.
  Eigen::Vector2d wave_vector(const Eigen::Vector2d &K) const;

  /// Stiffness of plane waves [1/s^2], that of bridge::WaveMatrices, from the force on a site in the crest of a wave
  /// with a strain of 1e-5; from the work of all forces in the mean over phases where points are scattered. @param K
  /// referential wave vector [1/m]
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

  /// Root mean square of the forces on scattered points in homogeneous deformation over the mean sum of the tensions of
  /// the bonds of a point [-].
  double imbalance(const Eigen::Matrix2d &F) const;

private:
  lattice::State state(const Eigen::Matrix2d &F) const;

  lattice::Material material_;
  std::vector<lattice::HalfBond> half_bonds_;
  lattice::TriangularLattice sheet_;
  Planted planted_;
};

} // namespace latcon::claims
