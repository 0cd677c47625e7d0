#pragma once

#include <optional>
#include <unordered_map>

#include "lattice/state.h"

namespace latcon::lattice
{

/// G_iJK = d^2 x_i / dX_J dX_K at a site [1/m], symmetric in J, K.
struct StrainGradient
{
  Eigen::Matrix2d x; ///< G_xJK
  Eigen::Matrix2d y; ///< G_yJK
};

/// Second derivatives of the positions by local least squares (theory.md, eq. (N.2)): the quadratic
///
///     x_j - x_i = F R + (1/2) G : R R,   R = X_j - X_i
///
/// is fitted to the bonded nearest and next-nearest neighbours j, all with one weight; third-nearest ones, farther off,
/// add nothing to what is local. Exact where the positions are a quadratic
/// function of X. The weights depend on which bonds a site has and on nothing else; they are found once for each
/// such set.
class StrainGradientFit
{
public:
  /// The lattice must outlive this object.
  explicit StrainGradientFit(const TriangularLattice &lattice) : lattice_(lattice) {}

  /// None where the bonds left do not fix a quadratic: a flank of a lattice of nearest neighbours has four, and five
  /// are needed. None on sheets other than the triangular lattice: not supported.
  /// @param place of a site, not in the margin
  std::optional<StrainGradient> at(const State &state, std::size_t place);

private:
  static constexpr std::size_t n_kinds = 2 * n_kinds_per_shell; // of bonds
  static constexpr std::size_t n_neighbours = 2 * n_kinds;
  /// Rows: G_xx, G_xy, G_yy; columns: neighbours in the order of bond kinds, forward ones first; zero for those
  /// missing.
  using Weights = Eigen::Matrix<double, 3, n_neighbours>;

  /// None if the bonds do not fix a quadratic.
  const std::optional<Weights> &weights(unsigned int bonds);

  const TriangularLattice &lattice_;
  std::unordered_map<unsigned int, std::optional<Weights>> weights_;
};

} // namespace latcon::lattice
