#pragma once

#include <limits>
#include <stdexcept>

namespace latcon::lattice
{

/// Uniaxial incompressible Mooney-Rivlin rod (theory.md, eqs. (L.2) and (L.3)), with a = 2 C1 and b = 2 C2 in Pa:
///   psi  = a (lam^2 / 2 + 1 / lam - 3/2) + b (lam + 1 / (2 lam^2) - 3/2)
///   psi' = a (lam - lam^-2) + b (1 - lam^-3)
/// With a negative constant the energy has no lower bound, psi -> a lam^2 / 2 in a long bond and b / (2 lam^2) in a
/// short one, and no stretch bounds the stiffness of the shorter bonds.
struct MooneyRivlinBond
{
  /// @throws std::invalid_argument unless a and b are non-negative, finite and not both 0
  MooneyRivlinBond(double a_, double b_) : a(a_), b(b_)
  {
    if (!(a >= 0. && b >= 0. && a + b > 0. && a + b < std::numeric_limits<double>::infinity()))
      throw std::invalid_argument("a Mooney-Rivlin bond needs constants a, b >= 0, one of them positive");
  }

  double a; ///< [Pa], >= 0
  double b; ///< [Pa], >= 0

  static constexpr bool stiffens_when_short = true; ///< whether short bonds may require divided steps

  /// psi(lam) [Pa], energy per reference volume of the bond.
  double energy(double stretch) const
  {
    const double inverse = 1. / stretch;
    return a * (0.5 * stretch * stretch + inverse - 1.5) + b * (stretch + 0.5 * inverse * inverse - 1.5);
  }

  /// psi''(lam) [Pa], axial tangent stiffness per reference cross-section.
  double stiffness(double stretch) const
  {
    const double inverse = 1. / stretch;
    const double inverse_cube = inverse * inverse * inverse;
    return a * (1. + 2. * inverse_cube) + 3. * b * inverse_cube * inverse;
  }

  /// Largest psi''(lam) [Pa] of all lam >= smallest_stretch, since psi''' <= 0 with a, b >= 0.
  double largest_stiffness(double smallest_stretch) const { return stiffness(smallest_stretch); }
};

} // namespace latcon::lattice
