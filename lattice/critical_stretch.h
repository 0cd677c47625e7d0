#pragma once

#include <algorithm>
#include <array>

#include "lattice/breaking_rule.h"
#include "lattice/material.h"

namespace latcon::lattice
{

/// A bond breaks beyond a stretch of its shell.
class CriticalStretch : public BreakingRule
{
public:
  /// @param stretch lam_f of each shell [-], > 0
  explicit CriticalStretch(const std::array<double, n_shells> &stretch) : stretch_(stretch) {}

  double limit(const Bond &bond) const override { return stretch_[bond.shell] * bond.toughening * bond.strength; }
  double smallest_limit(double toughening) const override
  {
    return *std::min_element(stretch_.begin(), stretch_.end()) * toughening;
  }
  double largest_limit(double toughening) const override
  {
    return *std::max_element(stretch_.begin(), stretch_.end()) * toughening;
  }

private:
  std::array<double, n_shells> stretch_;
};

} // namespace latcon::lattice
