#pragma once

#include <limits>
#include <stdexcept>

namespace latcon::lattice
{

/// Linear spring psi = (e / 2) (lam - 1)^2 with modulus e > 0 in Pa.
struct LinearBond
{
  /// @throws std::invalid_argument unless e is positive and finite
  explicit LinearBond(double modulus_) : modulus(modulus_)
  {
    if (!(modulus > 0. && modulus < std::numeric_limits<double>::infinity()))
      throw std::invalid_argument("a linear bond needs a positive modulus");
  }

  double modulus; ///< e [Pa], > 0

  static constexpr bool stiffens_when_short = false; ///< whether short bonds may require divided steps

  /// psi(lam) [Pa].
  double energy(double stretch) const { return 0.5 * modulus * (stretch - 1.) * (stretch - 1.); }

  /// psi''(lam) [Pa].
  double stiffness(double /*stretch*/) const { return modulus; }

  /// Constant for this law.
  double largest_stiffness(double /*smallest_stretch*/) const { return modulus; }
};

} // namespace latcon::lattice
