#pragma once

#include "continuum/material.h"

namespace latcon::continuum
{
/// Compressible Mooney-Rivlin sheet in plane stress (theory-continuum.md, eqs. (C.4) to (C.9)).
///   W(F) = min over F_33 of  c1 (I1 - 3 - 2 ln J) + c2 (I2 - 3 - 4 ln J) + (kappa/2) (J - 1)^2       [Pa]
/// with the invariants of the three-dimensional C = F^T F and J = F_33 det F.
///
/// c2 < 0 is allowed, because a calibration may need it. No equilibrium thickness exists then if
///   c1 + c2 |F|^2 + (kappa/2) (det F)^2 <= 0,
/// for which the law throws NonPhysicalState; strong ellipticity may be lost earlier (minimum_acoustic_eigenvalue).
class MooneyRivlin : public Material
{
public:
  /// Material constants [Pa]. Small-strain shear modulus mu = 2 (c1 + c2).
  struct Constants
  {
    double c1;
    double c2;
    double kappa;

    /// Returns constants with equal Lame constants in the small-strain limit in plane stress: shear modulus
    /// `shear_modulus` mu [Pa] > 0 and lambda = mu, that is, two-dimensional Poisson ratio 1/3. They are c1 = (1-r)
    /// mu/2, c2 = r mu/2, kappa = 2 mu (1-r), for the ratio r = c2/(c1 + c2) [-], -1 < r < 1 (theory-continuum.md, eq.
    /// (C.10)). Throws InvalidInput if an argument is out of range.
    static Constants with_equal_lame_constants(double shear_modulus, double ratio);
  };

  /// Creates the law. Throws InvalidInput unless 2 (c1 + c2) > 0, kappa > 0, and the thickness is stable at F = I: 4
  /// c1 + 8 c2 + kappa > 0.
  explicit MooneyRivlin(const Constants &constants);

  Response evaluate(const dealii::Tensor<2, 2> &F, Order order) const override;

  const Constants &constants() const { return constants_; }

private:
  Constants constants_;
};
} // namespace latcon::continuum
