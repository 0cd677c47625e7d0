#pragma once

#include "continuum/sheet.h"
#include "continuum/viscosity.h"

#include <vector>

namespace latcon::continuum
{
/// Nodal forces of a viscous law, C_a = integral of P_v(F, Fdot) : Grad phi_a dX (theory-continuum.md, eq. (C.40)),
/// with those of its gradient part, eq. (C.63). The nodal vectors u [m] and v [m/s] have ghost entries, and the rate of
/// the load factor `load_rate` [1/s] is that of prescribed normal gradients. All functions are collective, and throw
/// NonPhysicalState on every rank.
class ViscousForces
{
public:
  using Vector = Sheet::Vector;

  /// Creates the forces of `viscosity` on `sheet`; both must outlive this object. If `viscosity` is nullptr, all forces
  /// are zero. Throws InvalidInput for a viscosity with a gradient part on a sheet without a gradient law.
  ViscousForces(const Sheet &sheet, const Viscosity *viscosity);

  /// Adds C [N/m] to `forces` and, if given, the absolute values of its terms to `magnitude`.
  void add_forces(const Vector &u, const Vector &v, double load_rate, Vector &forces, Vector *magnitude) const;

  /// Adds dC/du [N/m^2] to `matrix`, condensed by `constraints`, with dv/du = `rate_by_displacement` [1/s].
  void add_tangent(const Vector &u, const Vector &v, double load_rate, double rate_by_displacement,
                   const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &matrix) const;

  /// Adds the first Piola stresses P_v [Pa] at the points of the elastic energy, the cells on this rank in their order.
  void add_stresses(const Vector &u, const Vector &v, std::vector<dealii::Tensor<2, 2>> &stresses) const;

  /// Returns the dissipated power [W/m] per unit reference thickness, the integral of P_v : Fdot. It exceeds that of
  /// the nodal forces by the power of prescribed normal gradients.
  double dissipation(const Vector &u, const Vector &v, double load_rate) const;

private:
  const Sheet &sheet_;
  const Viscosity *viscosity_;
};
} // namespace latcon::continuum
