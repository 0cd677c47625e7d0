#include "continuum/mooney_rivlin.h"

#include "continuum/errors.h"
#include "continuum/plane_invariants.h"

#include <cmath>

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// In-plane invariants |F|^2 and j = det F of the sheet, and the resulting thickness stretch t.
struct Invariants
{
  double F_squared;
  double j;
  double t;
  double A; // coefficients of the thickness equation A t^2 - kappa j t - B = 0, eq. (C.5)
  double B;
};

// Closed-form root of the quadratic thickness equation. For A > 0 and B > 0 it is the only positive root and no digits
// cancel. For B < 0 it is the larger of two, the local minimum of the energy.
Invariants invariants(const MooneyRivlin::Constants &m, const Tensor<2, 2> &F)
{
  Invariants s;
  s.j = checked_determinant(F);
  s.F_squared = F.norm_square();
  s.A = 2. * m.c1 + 2. * m.c2 * s.F_squared + m.kappa * s.j * s.j;
  s.B = 2. * m.c1 + 4. * m.c2;
  const double discriminant = m.kappa * s.j * m.kappa * s.j + 4. * s.A * s.B;
  if (!(s.A > 0. && discriminant > 0. && std::isfinite(discriminant)))
    throw NonPhysicalState("no stable equilibrium thickness exists: " + text_of(F));
  s.t = (m.kappa * s.j + std::sqrt(discriminant)) / (2. * s.A);
  return s;
}
} // namespace

MooneyRivlin::Constants MooneyRivlin::Constants::with_equal_lame_constants(const double shear_modulus,
                                                                           const double ratio)
{
  require(shear_modulus > 0. && ratio > -1. && ratio < 1.,
          "equal Lame constants need a shear modulus > 0 and a ratio c2/(c1+c2) in (-1, 1)");
  return {0.5 * (1. - ratio) * shear_modulus, 0.5 * ratio * shear_modulus, 2. * (1. - ratio) * shear_modulus};
}

MooneyRivlin::MooneyRivlin(const Constants &constants) : constants_(constants)
{
  const auto &[c1, c2, kappa] = constants;
  require(std::isfinite(c1) && std::isfinite(c2) && std::isfinite(kappa), "Mooney-Rivlin constants must be finite");
  require(c1 + c2 > 0., "Mooney-Rivlin needs a positive shear modulus 2 (c1 + c2)");
  require(kappa > 0., "Mooney-Rivlin needs kappa > 0");
  // d2W/dF33^2 at F = I: the thickness of the unloaded sheet is stable if it is positive.
  require(2. * (2. * c1 + 4. * c2) + kappa > 0.,
          "Mooney-Rivlin needs 4 c1 + 8 c2 + kappa > 0 for the thickness of the unloaded sheet to be stable");
}

Response MooneyRivlin::evaluate(const Tensor<2, 2> &F, const Order order) const
{
  const auto &[c1, c2, kappa] = constants_;
  const Invariants s = invariants(constants_, F);
  const double J = s.j * s.t;
  const double log_J = std::log(J);
  const double I1 = s.F_squared + s.t * s.t;
  const double I2 = s.j * s.j + s.t * s.t * s.F_squared;
  const double energy = c1 * (I1 - 3. - 2. * log_J) + c2 * (I2 - 3. - 4. * log_J) + 0.5 * kappa * (J - 1.) * (J - 1.);
  // First derivatives at fixed thickness, eq. (C.7), and second ones with the thickness eliminated, eq. (C.8).
  const double by_F_squared = c1 + c2 * s.t * s.t;
  const double by_j = -s.B / s.j + 2. * c2 * s.j + kappa * s.t * (s.j * s.t - 1.);
  const double tt = s.A + s.B / (s.t * s.t);
  const double ft = 2. * c2 * s.t;
  const double jt = kappa * (2. * s.j * s.t - 1.);
  const double jj = s.B / (s.j * s.j) + 2. * c2 + kappa * s.t * s.t;
  return response(InvariantFunction({energy, by_F_squared, by_j, -ft * ft / tt, -ft * jt / tt, jj - jt * jt / tt}), F,
                  order);
}
} // namespace latcon::continuum
