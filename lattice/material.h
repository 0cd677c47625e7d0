#pragma once

#include <optional>

#include "lattice/bonds/bond_law.h"
#include "lattice/bonds/bond_memory.h"
#include "lattice/disorder.h"
#include "lattice/triangular_lattice.h"

namespace latcon::lattice
{

/// One shell of bonds: nearest or next-nearest neighbours.
struct Shell
{
  BondLaw law;
  /// s [-], > 0: cross-section of a bond over (sqrt3 / 2) d h (theory.md, eq. (L.4)). The source paper leaves it open.
  double area_factor;
  /// eta [Pa s], >= 0: viscosity of the Kelvin dashpot along the bond.
  double viscosity;
  /// Overstress that depends on the past of a bond; none by default.
  BondMemory memory = NoMemory();
};

/// Material of the sheet. All extensive quantities of the lattice are per unit sheet thickness h, which cancels
/// from the motion: masses in kg/m, forces in N/m, energies in J/m.
struct Material
{
  double density; ///< rho [kg/m^3], > 0
  Shell nearest;
  std::optional<Shell> next_nearest; ///< none: a lattice of nearest neighbours alone
  Disorder disorder = {};            ///< factors of the bonds of all shells; none by default

  /// Shell of a bond kind; nullptr where the lattice has no such bonds.
  const Shell *shell(std::size_t kind) const
  {
    if (TriangularLattice::is_nearest(kind))
      return &nearest;
    return next_nearest ? &*next_nearest : nullptr;
  }

  /// Returns whether bonds of some kind have a memory.
  bool has_memory() const;

  /// Number of mechanisms by which memories store and dissipate energy: those of the nearest neighbours, then those of
  /// the next-nearest.
  std::size_t n_mechanisms() const;

  /// Bonds of a site inside the sheet: 6 or 12.
  unsigned int coordination() const { return next_nearest ? 12 : 6; }
};

/// Returns the bonds with their dashpots, but without memories.
Material without_memory(Material material);

/// Returns the bonds without their dashpots and memories, as they are in equilibrium.
Material without_dashpots(Material material);

/// A0 / h = s (sqrt3 / 2) d [m], cross-section of a bond per sheet thickness (theory.md, eq. (L.4)).
double cross_section(const Shell &shell, const TriangularLattice &lattice);

/// m / h = rho (sqrt3 / 2) d^2 [kg/m], mass of a site per sheet thickness (theory.md, eq. (L.1)).
double site_mass(const Material &material, const TriangularLattice &lattice);

} // namespace latcon::lattice
