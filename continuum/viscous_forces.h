#pragma once

#include "continuum/sheet.h"
#include "continuum/viscosity.h"

namespace latcon::continuum
{
/// Nodal forces of a viscosity, C_a = integral of P_v(F, Fdot) : Grad phi_a dX (theory-continuum.md, eq. (C.40)), zero
/// without one. The nodal vectors u [m] and v [m/s] have ghost entries. All functions are collective, and throw
/// NonPhysicalState on every rank.
class ViscousForces
{
public:
  using Vector = Sheet::Vector;

  /// Both must outlive this; `viscosity` may be nullptr.
  ViscousForces(const Sheet &sheet, const Viscosity *viscosity) : sheet_(sheet), viscosity_(viscosity) {}

  /// Adds C [N/m] to `forces`, and the absolute values it is summed of to `magnitude`, if given.
  void add_forces(const Vector &u, const Vector &v, Vector &forces, Vector *magnitude) const;

  /// Adds dC/du [N/m^2], condensed, to `matrix`, where dv/du = rate_by_displacement [1/s].
  void add_tangent(const Vector &u, const Vector &v, double rate_by_displacement,
                   const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &matrix) const;

  /// Integral of P_v : Fdot [W/m], per unit reference thickness.
  double dissipation(const Vector &u, const Vector &v) const;

private:
  const Sheet &sheet_;
  const Viscosity *viscosity_;
};
} // namespace latcon::continuum
