#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "lattice/material.h"

namespace latcon::lattice
{

/// When a bond breaks: the stretch beyond which it does, which may depend on the bond and its motion.
///
/// Loops over rows only screen: they flag rows with a bond beyond smallest_limit(). The rule is asked about the bonds
/// of these rows alone, one by one.
class BreakingRule
{
public:
  /// A bond that is asked about.
  struct Bond
  {
    std::size_t shell;
    double toughening = 1.; ///< factor of the limit, >= 1, of bonds that have toughened; may be infinite
    double strength = 1.;   ///< factor of the limit by disorder
    double stiffness = 1.;  ///< factor of its cross-section by disorder
    double rate = 0.;       ///< of its stretch [1/s]
  };

  virtual ~BreakingRule() = default;

  /// Stretch beyond which the bond breaks [-].
  virtual double limit(const Bond &bond) const = 0;

  /// A stretch that, times the strength of a bond, no limit of a bond with this toughening is below [-].
  virtual double smallest_limit(double toughening) const = 0;

  /// A stretch that, times the strength of a bond, no limit of a bond with this toughening exceeds [-].
  virtual double largest_limit(double /*toughening*/) const { return std::numeric_limits<double>::infinity(); }
};

/// A bond breaks beyond a stretch of its shell. It may grow with the rate r of the stretch from lam_f to `factor`
/// lam_f: lam_f (1 + (factor - 1) r tau / (1 + r tau)), and lam_f where the bond contracts.
class CriticalStretch : public BreakingRule
{
public:
  /// @param stretch lam_f of each shell [-], > 0 @param factor [-], >= 1 @param time tau [s], > 0
  explicit CriticalStretch(const std::array<double, n_shells> &stretch, double factor = 1., double time = 0.)
    : stretch_(stretch), factor_(factor), time_(time)
  {
  }
  /// One lam_f for all shells. @throws std::invalid_argument unless it is positive
  explicit CriticalStretch(double stretch, double factor = 1., double time = 0.);

  double limit(const Bond &bond) const override;
  double smallest_limit(double toughening) const override
  {
    return *std::min_element(stretch_.begin(), stretch_.end()) * toughening;
  }
  double largest_limit(double toughening) const override
  {
    return *std::max_element(stretch_.begin(), stretch_.end()) * factor_ * toughening;
  }

private:
  std::array<double, n_shells> stretch_;
  double factor_, time_;
};

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
