#include "lattice/material.h"

namespace latcon::lattice
{

Material without_dashpots(Material material)
{
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
