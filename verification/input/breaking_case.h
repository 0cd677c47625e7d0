#pragma once

#include <memory>
#include <vector>

#include "lattice/breaking_rule.h"

namespace latcon::input
{

struct Case;
class Parameters;

/// Entries of a case for the rule by which bonds break, besides lam_f.
struct BreakingCase
{
  enum class Rule
  {
    critical_stretch,
    rate_stretch,
    bond_energy
  };

  Rule rule = Rule::critical_stretch;
  std::vector<double> shell_factors = {}; ///< of lam_f, by shell; empty: all 1
  double rate_factor = 1.;                ///< of lam_f at high rates [-]
  double rate_time = 1e-4;                ///< tau [s]

  void declare(Parameters &parameters);
  void check(const Case &input, Parameters &parameters) const;
  /// Largest limit of a bond that has not toughened over lam_f, for rules that do not ask for the law of the bonds.
  double largest_factor() const;
  /// The rule. @param input with a breaking stretch; bond-energy needs its material
  std::shared_ptr<const lattice::BreakingRule> make(const Case &input) const;
};

} // namespace latcon::input
