#include "lattice/bonds/custom_memory.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace latcon::lattice
{

CustomMemory::CustomMemory(std::shared_ptr<const CustomMemoryLaw> law) : law_(std::move(law))
{
  if (!law_)
    throw std::invalid_argument("a memory needs a law");
  const std::size_t n = law_->n_variables();
  if (n < 1 || n > max_history_variables)
    throw std::invalid_argument("a memory has 1 to " + std::to_string(max_history_variables) + " variables, not " +
                                std::to_string(n));
  const double stiffness = law_->largest_stiffness();
  if (!(stiffness >= 0. && std::isfinite(stiffness)))
    throw std::invalid_argument("a memory needs a finite stiffness >= 0, not " + std::to_string(stiffness) + " Pa");
  std::array<double, max_history_variables> at_rest{};
  const double overstress = law_->advance(0., 1., 1., at_rest.data());
  if (!(overstress == 0. && law_->stored_energy(1., at_rest.data()) == 0. &&
        law_->dissipation(1., at_rest.data()) == 0.))
    throw std::invalid_argument("a memory holds neither overstress nor energy while its variables are 0, and "
                                "dissipates nothing");
}

} // namespace latcon::lattice
