#include "verification/bridge/small_strain.h"

#include <cmath>

namespace latcon::bridge
{

std::string shells_name(const lattice::Material &material)
{
  return std::string("NN") + (material.next_nearest ? "+NNN" : "") + (material.third_nearest ? "+3NN" : "");
}

double bond_weight(const lattice::TriangularLattice &lattice, const lattice::Shell &shell, std::size_t kind)
{
  return lattice::cross_section(shell, lattice) * lattice.rest_length(kind) / lattice.site_area();
}

SmallStrain small_strain(const lattice::TriangularLattice &lattice, const lattice::Material &material)
{
  // Three unit vectors 60 degrees apart have sum N N N N = (3/8) (dd + dd + dd).
  double mu = 0.;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = material.in_shell(number))
      mu += 3. / 8. * bond_weight(lattice, *shell, number * lattice::n_kinds_per_shell) *
            lattice::stiffness(shell->law, 1.);
  return {mu, std::sqrt(mu / material.density), std::sqrt(3. * mu / material.density)};
}

} // namespace latcon::bridge
