#include "lattice/bonds/plastic_memory.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace latcon::lattice
{

PlasticMemory::PlasticMemory(double modulus, double yield_stress, double hardening)
  : step_{modulus, yield_stress, hardening, 1. / (modulus + hardening)}
{
  if (!(modulus > 0. && yield_stress > 0. && hardening >= 0. && std::isfinite(modulus + yield_stress + hardening)))
    throw std::invalid_argument("a plastic memory needs a modulus > 0, a yield stress > 0 and a hardening >= 0, not " +
                                std::to_string(modulus) + " Pa, " + std::to_string(yield_stress) + " Pa and " +
                                std::to_string(hardening) + " Pa");
}

} // namespace latcon::lattice
