#include "lattice/material.h"

#include <utility>

namespace latcon::lattice
{

bool Material::has_memory() const
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (const Shell *shell = in_shell(number); shell != nullptr && n_variables(shell->memory) > 0)
      return true;
  return false;
}

std::size_t Material::first_mechanism(std::size_t shell) const
{
  std::size_t before = 0;
  for (std::size_t number = 0; number < shell; ++number)
    if (const Shell *other = in_shell(number))
      before += lattice::n_mechanisms(other->memory);
  return before;
}

unsigned int Material::coordination() const
{
  unsigned int bonds = 0;
  for (std::size_t number = 0; number < n_shells; ++number)
    if (in_shell(number) != nullptr)
      bonds += 2 * n_kinds_per_shell;
  return bonds;
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
  if (lattice.scattered() == nullptr)
    return coordination(lattice);
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
      shell->memory = NoMemory();
  return material;
}

Material without_dashpots(Material material)
{
  material = without_memory(std::move(material));
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material.in_shell(number))
      shell->viscosity = 0.;
  return material;
}

double cross_section(const Shell &shell, const TriangularLattice &lattice, std::size_t kind)
{
  return shell.area_factor * lattice.site_area() / lattice.section_length(kind);
}

double site_mass(const Material &material, const TriangularLattice &lattice)
{
  return material.density * lattice.site_area();
}

} // namespace latcon::lattice
