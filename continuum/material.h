#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <string>

namespace latcon::continuum
{
/// Highest derivative to compute.
enum class Order
{
  value = 0,
  first = 1,
  second = 2
};

/// Energy of a law at a point and its derivatives by F up to an order; those beyond it are zero.
struct Response
{
  double energy = 0.;               ///< W [Pa = J/m^3], zero at F = I
  dealii::Tensor<2, 2> first_piola; ///< P_iJ = dW/dF_iJ [Pa]: force per reference length and unit reference thickness
  dealii::Tensor<4, 2> tangent;     ///< dP_iJ/dF_kL [Pa], index order [i][J][k][L]; major symmetric
};

/// Hyperelastic law of a sheet: energy, stress and tangent. Laws are const and stateless.
///
/// F_iJ = dx_i/dX_J is the in-plane deformation gradient (current index first, reference index second). Densities are
/// per reference volume, that is, per reference area and unit reference thickness. All functions throw
/// NonPhysicalState, with F in the message, if det F <= 0 or F is not finite.
///
/// Symbols as in theory-continuum.md, eq. (C.1). For gradient terms see GradientLaw, whose energy W_g(F, Grad F) is
/// added to this one.
class Material
{
public:
  virtual ~Material() = default;

  /// Returns the law at a reference position X [m], another one than this in parts of a sheet that is not uniform.
  virtual const Material &at(const dealii::Point<2> & /*X*/) const { return *this; }

  /// Returns the energy and its derivatives up to `order`.
  virtual Response evaluate(const dealii::Tensor<2, 2> &F, Order order) const = 0;

  double energy(const dealii::Tensor<2, 2> &F) const { return evaluate(F, Order::value).energy; }
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F) const
  {
    return evaluate(F, Order::first).first_piola;
  }
  dealii::Tensor<4, 2> tangent(const dealii::Tensor<2, 2> &F) const { return evaluate(F, Order::second).tangent; }
};

/// Returns F in words for messages, "F = [1 0; 0 1]", with all digits.
std::string text_of(const dealii::Tensor<2, 2> &F);

/// Returns det F [-] of the in-plane deformation gradient. Throws NonPhysicalState unless it is finite and > 0. To be
/// called before any logarithm or power of the state.
double checked_determinant(const dealii::Tensor<2, 2> &F);

/// Returns the Cauchy stress sigma_ij = P_iJ F_jJ / det F [Pa], det F in-plane (theory-continuum.md, eq. (C.2)): force
/// per current length and REFERENCE thickness. The thickness change is excluded, because a lattice has no thickness to
/// compare with; the true stress of a sheet with thickness stretch F_33 is this stress divided by F_33.
dealii::Tensor<2, 2> cauchy_stress(const dealii::Tensor<2, 2> &P, const dealii::Tensor<2, 2> &F);

/// Returns the smallest eigenvalue [Pa] of the acoustic tensor Q_ik(n) = T_iJkL n_J n_L of the tangent T at F over all
/// reference directions n (theory-continuum.md, eq. (C.3)), which is rho c^2 of the slowest plane wave. The law is
/// strongly elliptic at F if and only if this eigenvalue is positive. Relative accuracy 1e-10. Throws NonPhysicalState
/// as the law does.
double minimum_acoustic_eigenvalue(const Material &law, const dealii::Tensor<2, 2> &F);
} // namespace latcon::continuum
