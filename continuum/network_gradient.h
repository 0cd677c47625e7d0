#pragma once

#include "continuum/lattice_gradient.h"

namespace latcon::continuum
{
/// The gradient energy of a network with all directions alike: the mean of LatticeGradient over all rotations of its
/// reference configuration (theory-continuum.md, eq. (C.57)), as a sum over equispaced directions. It goes with the law
/// IsotropicNetwork as LatticeGradient goes with CauchyBorn.
///
/// The sum is a law of its own, objective and with exact derivatives. With all fibres beyond full_stretch, what it
/// lacks to isotropy falls as the n-th power of (l1 - l2)/(l1 + l2), l1 and l2 the principal stretches, with the number
/// n of directions.
class NetworkGradient : public LatticeGradient
{
public:
  /// Directions in half a turn. The dependence on direction is below 1e-6 of the energy up to l1/l2 = 3 if all fibres
  /// are stretched by 2 % or more, else below 1e-2 up to 6.
  static constexpr unsigned int n_directions = 32;

  /// The directions of `families` do not matter; `length` l_d [m]. Throws InvalidMaterial as LatticeGradient does.
  /// Families with the same potential act as one, of their mean squared length, and l_d has to satisfy (C.58) alone.
  NetworkGradient(const std::vector<BondFamily> &families, double length);

  /// The shortest l_d [m] for which the energy is positive: the largest root mean squared length of bonds with the same
  /// potential, over sqrt(12) (theory-continuum.md, eq. (C.58)).
  static double smallest_length(const std::vector<BondFamily> &families);
};
} // namespace latcon::continuum
