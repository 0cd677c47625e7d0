#pragma once

#include "lattice/breaking_rule.h"
#include "lattice/material.h"

namespace latcon::lattice
{

/// A bond breaks once its spring stores more than a critical energy per reference volume, which toughening and strength
/// multiply. For laws whose energy is a convex function of the stretch.
class BondEnergy : public BreakingRule
{
public:
  /// @param energy critical energy [J/m^3], > 0
  BondEnergy(const Material &material, double energy);

  double limit(const Bond &bond) const override;
  double smallest_limit(double toughening) const override;

private:
  /// Stretch > 1 at which the law of a shell stores an energy [J/m^3].
  double stretch_at(std::size_t shell, double energy) const;

  Material material_;
  double energy_;
};

} // namespace latcon::lattice
