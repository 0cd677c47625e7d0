#include "lattice/material.h"

#include <utility>

namespace latcon::lattice
{

bool Material::has_memory() const
{
  return n_variables(nearest.memory) > 0 || (next_nearest && n_variables(next_nearest->memory) > 0);
}

std::size_t Material::n_mechanisms() const
{
  return lattice::n_mechanisms(nearest.memory) + (next_nearest ? lattice::n_mechanisms(next_nearest->memory) : 0);
}

Material without_memory(Material material)
{
  material.nearest.memory = NoMemory();
  if (material.next_nearest)
    material.next_nearest->memory = NoMemory();
  return material;
}

Material without_dashpots(Material material)
{
  material = without_memory(std::move(material));
  material.nearest.viscosity = 0.;
  if (material.next_nearest)
    material.next_nearest->viscosity = 0.;
  return material;
}

double cross_section(const Shell &shell, const TriangularLattice &lattice)
{
  return shell.area_factor * lattice.site_area() / lattice.spacing();
}

double site_mass(const Material &material, const TriangularLattice &lattice)
{
  return material.density * lattice.site_area();
}

} // namespace latcon::lattice
