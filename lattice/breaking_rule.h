#pragma once

#include <cstddef>
#include <limits>

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

} // namespace latcon::lattice
