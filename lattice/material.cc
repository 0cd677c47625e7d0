#include "lattice/material.h"

#include <utility>

namespace latcon::lattice
{

std::size_t Material::first_mechanism(std::size_t shell) const
{
  std::size_t before = 0;
  for (std::size_t number = 0; number < shell; ++number)
    if (const Shell *other = in_shell(number))
      before += lattice::n_mechanisms(other->memory);
  return before;
}

unsigned int Material::coordination(const TriangularLattice &lattice) const
{
  unsigned int bonds = 0;
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (shell(lattice, kind) != nullptr)
      bonds += 2;
  return bonds;
}

unsigned int Material::coordination(const TriangularLattice &lattice, std::size_t place) const
{
  unsigned int bonds = 0;
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (shell(lattice, kind) != nullptr)
      for (const Bond &bond : {lattice.bond(place, kind), lattice.bond_into(place, kind)})
        bonds += lattice.has_bond(bond.near, kind) ? 1 : 0;
  return bonds;
}

Material without_memory(Material material)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material.in_shell(number))
      shell->memory = {};
  return material;
}

Material without_dashpots(Material material)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material.in_shell(number))
      shell->viscosity = 0.;
  return without_memory(std::move(material));
}

} // namespace latcon::lattice
