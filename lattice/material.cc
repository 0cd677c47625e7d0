#include "lattice/material.h"

namespace lattice
{

double cross_section(const Shell &shell, const TriangularLattice &lattice)
{
  return shell.area_factor * lattice.site_area() / lattice.spacing();
}

double site_mass(const Material &material, const TriangularLattice &lattice)
{
  return material.density * lattice.site_area();
}

} // namespace lattice
