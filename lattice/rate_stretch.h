#pragma once

#include <algorithm>

#include "lattice/breaking_rule.h"

namespace latcon::lattice
{

/// A bond breaks beyond a stretch that grows with its rate r from lam_f to `factor` lam_f:
/// lam_f (1 + (factor - 1) r tau / (1 + r tau)), and lam_f where it contracts.
class RateStretch : public BreakingRule
{
public:
  /// @param stretch lam_f [-], > 0 @param factor [-], >= 1 @param time tau [s], > 0
  RateStretch(double stretch, double factor, double time) : stretch_(stretch), factor_(factor), time_(time) {}

  double limit(const Bond &bond) const override
  {
    const double rate = time_ * std::max(bond.rate, 0.);
    return stretch_ * (1. + (factor_ - 1.) * (rate / (1. + rate))) * bond.toughening * bond.strength;
  }
  double smallest_limit(double toughening) const override { return stretch_ * toughening; }
  double largest_limit(double toughening) const override { return stretch_ * factor_ * toughening; }

private:
  double stretch_, factor_, time_;
};

} // namespace latcon::lattice
