#pragma once

#include <set>

#include "verification/input/case.h"

namespace latcon::bridge
{

/// Laws of the continuum that claims set beside a lattice.
enum class Law
{
  cauchy_born,           ///< the lattice's own, local
  lattice_gradient,      ///< the same with the gradient energy of the lattice's long waves
  isotropic_gradient,    ///< the same with the isotropic gradient energy
  mooney_rivlin_network, ///< local, the lattice's mean over all directions
  mooney_rivlin          ///< local, of plane stress, calibrated along the loading path
};

/// Laws on which a run relies. Claims judge what they find about these, and report what they find about others.
using Laws = std::set<Law>;

/// Every law.
inline Laws all_laws()
{
  return {Law::cauchy_born, Law::lattice_gradient, Law::isotropic_gradient, Law::mooney_rivlin_network,
          Law::mooney_rivlin};
}

/// Laws of a run on the lattice alone: the continuum that its bonds make, and no law that was fitted to it.
inline Laws laws_of_lattice()
{
  return {Law::cauchy_born, Law::lattice_gradient};
}

/// Laws of the runs of a case: those of its lattice, and those that its finite elements ask for.
inline Laws laws_of(const input::Case &input)
{
  Laws laws = laws_of_lattice();
  if (input.continuum.law == input::ContinuumLaw::mooney_rivlin)
    laws.insert(Law::mooney_rivlin);
  if (input.continuum.law == input::ContinuumLaw::mooney_rivlin_network)
    laws.insert(Law::mooney_rivlin_network);
  if (input.continuum.gradient == input::ContinuumGradient::isotropic)
    laws.insert(Law::isotropic_gradient);
  return laws;
}

} // namespace latcon::bridge
