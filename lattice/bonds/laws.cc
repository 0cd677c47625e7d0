#include "lattice/bonds/laws.h"

#include <cmath>
#include <string>

#include "support/require.h"

namespace latcon::lattice
{

CustomBond::CustomBond(std::shared_ptr<const CustomBondLaw> law) : law_(std::move(law))
{
  support::require(law_ != nullptr, "a bond needs a law");
  const double stiffness = law_->stiffness(1.);
  const double round_off = 1e-12 * stiffness;
  support::require(std::isfinite(stiffness) && stiffness > 0.,
                   "a bond needs a finite stiffness > 0 at rest, not " + std::to_string(stiffness) + " Pa");
  support::require(std::abs(law_->energy(1.)) <= round_off && std::abs(law_->force(1.)) <= round_off,
                   "a bond holds neither energy nor force at rest, not " + std::to_string(law_->energy(1.)) + " and " +
                     std::to_string(law_->force(1.)) + " Pa");
}

} // namespace latcon::lattice
