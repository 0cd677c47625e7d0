#pragma once

#include "lattice/site_forces.h"

namespace latcon::lattice
{

/// Long-wave tangent along x of the sheet at x = F X: rho c^2 p = A p for a plane wave along X with referential speed c
/// and polarisation p, A = (1/V) sum_k A0 l (N_k . e_x)^2 h_k [Pa], h_k = psi'' n n + (psi'/lam)(I - n n)
/// (theory-comparison.md, eqs. (W.1) and (W.2)), sum over the bonds that a site owns. Symmetric.
/// @param is_fast psi'' + largest_stiffness() of the memory in place of psi''
Eigen::Matrix2d tangent_along_x(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F,
                                bool is_fast = false);

/// Returns whether both long waves along x propagate in the sheet at x = F X, i.e. tangent_along_x is positive
/// definite. An absorbing end requires it.
bool waves_run_along_x(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F);

/// Impedance of an absorbing end per site of it and sheet thickness [Pa s], p sqrt(rho A) (theory.md, eq. (L.16)), with
/// the row pitch p and A = tangent_along_x, which must be positive definite, of fast motion.
Eigen::Matrix2d end_impedance(const TriangularLattice &lattice, const Material &material, const Eigen::Matrix2d &F);

/// Loads that represent the rest of an endless sheet at its short ends, on the sites there that are not held
/// (theory.md, eqs. (L.15) and (L.16)).
///
/// Dead load: what the bonds that are missing would pull with in the sheet at x = F X, so that this sheet is an exact
/// equilibrium. Absorbing: besides, on the outermost site of each row that ends there, -sqrt(rho A) v times the row
/// pitch, A being tangent_along_x: long plane waves that arrive along x leave the sheet (Lysmer and Kuhlemeyer 1969).
/// Bonds with a memory enter A with its largest_stiffness(): for Maxwell branches their stiffness in fast motion, so
/// that waves with w tau >> 1 leave; for a CustomMemory the bound that it declares, and as exact as that. Of slower
/// waves, a share of (sqrt(A) - sqrt(A_relaxed)) / (sqrt(A) + sqrt(A_relaxed)) of the amplitude is reflected.
class EndLoads : public SiteForces
{
public:
  enum class End
  {
    held, ///< no load
    free,
    absorbing
  };

  /// @param band rows on whose sites to act
  /// @param state the unbroken sheet, which tells held sites; see homogeneous_state()
  /// @throws std::invalid_argument if an absorbing end has a tangent that is not positive definite
  EndLoads(const RowPartition &band, const Material &material, const State &state, const Eigen::Matrix2d &F, End left,
           End right);

  const std::vector<SiteForce> &evaluate(State &state, VectorField &velocity) override;

private:
  std::vector<SiteForce> dead_;
  std::vector<std::size_t> absorbing_; // sites
  Eigen::Matrix2d impedance_;          // [Pa s], force per velocity of a site and sheet thickness
};

} // namespace latcon::lattice
