#pragma once

#include <set>

#include "verification/input/case.h"

namespace latcon::bridge
{

/// Continuum laws that claims compare with a lattice.
enum class Law
{
  cauchy_born,           ///< Cauchy-Born law of the lattice, local
  lattice_gradient,      ///< Cauchy-Born law with the gradient energy of the long waves of the lattice
  isotropic_gradient,    ///< Cauchy-Born law with the isotropic gradient energy
  mooney_rivlin_network, ///< mean of the Cauchy-Born law over all directions, local
  mooney_rivlin          ///< plane-stress law, local, calibrated along the loading path
};

/// Laws on which a run relies. Claims judge results for these laws, and only report results for other laws.
using Laws = std::set<Law>;

/// Returns all laws.
inline Laws all_laws()
{
  return {Law::cauchy_born, Law::lattice_gradient, Law::isotropic_gradient, Law::mooney_rivlin_network,
          Law::mooney_rivlin};
}

/// Returns the laws for a run of the lattice alone: those derived from its bonds, without fitted laws.
inline Laws laws_of_lattice()
{
  return {Law::cauchy_born, Law::lattice_gradient};
}

/// Returns the laws for the runs of a case: those of its lattice, and those of its finite elements.
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
