#include "lattice/bonds/laws.h"

#include <cmath>
#include <string>

namespace latcon::lattice
{

CustomBond::CustomBond(std::shared_ptr<const CustomBondLaw> law) : law_(std::move(law))
{
  if (!law_)
    throw std::invalid_argument("a bond needs a law");
  const double stiffness = law_->stiffness(1.);
  const double round_off = 1e-12 * stiffness;
  if (!(std::isfinite(stiffness) && stiffness > 0.))
    throw std::invalid_argument("a bond needs a finite stiffness > 0 at rest, not " + std::to_string(stiffness) +
                                " Pa");
  if (!(std::abs(law_->energy(1.)) <= round_off && std::abs(law_->force(1.)) <= round_off))
    throw std::invalid_argument("a bond holds neither energy nor force at rest, not " +
                                std::to_string(law_->energy(1.)) + " and " + std::to_string(law_->force(1.)) + " Pa");
}

} // namespace latcon::lattice
