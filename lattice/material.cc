#include "lattice/material.h"

namespace latcon::lattice
{

bool Material::has_memory() const
{
  return n_variables(nearest.memory) > 0 || (next_nearest && n_variables(next_nearest->memory) > 0);
}

Material without_dashpots(Material material)
{
  const auto remove = [](Shell &shell)
  {
    shell.viscosity = 0.;
    shell.memory = NoMemory();
  };
  remove(material.nearest);
  if (material.next_nearest)
    remove(*material.next_nearest);
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
