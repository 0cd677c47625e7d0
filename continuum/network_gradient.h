#pragma once

#include "continuum/lattice_gradient.h"

namespace latcon::continuum
{
/// Isotropic gradient law of a network of bonds: mean of LatticeGradient over all rotations of the reference
/// configuration (theory-continuum.md, eq. (C.25)), as a sum over equispaced directions. To be combined with
/// IsotropicNetwork, as LatticeGradient with CauchyBorn.
///
/// The sum is itself an objective law with exact derivatives. If all fibres are stretched beyond full_stretch, its
/// anisotropy decreases with the number n of directions as ((l1 - l2)/(l1 + l2))^n, with the principal stretches l1 and
/// l2.
class NetworkGradient : public LatticeGradient
{
public:
  /// Number of directions in half a turn. The anisotropy is below 1e-6 of the energy up to l1/l2 = 3 if all fibres are
  /// stretched by 2 % or more, and otherwise below 1e-2 up to l1/l2 = 6.
  static constexpr unsigned int n_directions = 32;

  /// Creates the law from `families`, whose directions are ignored, and `length` l_d [m]. Families with the same
  /// potential are merged into one with their mean squared length, so l_d only needs to satisfy eq. (C.58): it is at
  /// least the largest root-mean-square length of bonds with the same potential, over sqrt(12). Throws InvalidInput as
  /// LatticeGradient does.
  NetworkGradient(const std::vector<BondFamily> &families, double length);
};
} // namespace latcon::continuum
