#pragma once

namespace latcon::continuum
{
/// Constants of a damage field phi in [0, 1] (theory-damage.md, eqs. (C.59) to (C.61)).
struct DamageLaw
{
  double threshold; ///< W_c > 0 [J/m^3]: stored energy density of a homogeneous state at which damage begins
  double length;    ///< xi > 0 [m]: a crack damages the material to a distance of 2 xi
  /// k in (0, 1) [-]: factor of the stored energy where phi = 1, which keeps the equations solvable.
  double residual_stiffness = 1e-6;

  /// G_c = 16/3 (1 - k) xi W_c [J/m^2]: energy of a crack per reference length and thickness, eq. (C.61).
  double fracture_energy() const { return 16. / 3. * (1. - residual_stiffness) * length * threshold; }

  /// g(phi) = k + (1 - k) (1 - phi)^2 [-], eq. (C.60).
  double degradation(const double d) const
  {
    return residual_stiffness + (1. - residual_stiffness) * (1. - d) * (1. - d);
  }
};
} // namespace latcon::continuum
