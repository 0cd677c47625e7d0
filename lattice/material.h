#pragma once

#include <optional>
#include <utility>

#include "lattice/bonds/formulas.h"
#include "lattice/disorder.h"
#include "lattice/triangular_lattice.h"

namespace latcon::lattice
{

/// One shell of bonds; see n_shells.
struct Shell
{
  BondLaw law;
  /// s [-], > 0: cross-section of a bond over (sqrt3 / 2) d h (theory.md, eq. (L.4)). The source paper leaves it open.
  double area_factor;
  /// eta [Pa s], >= 0: viscosity of the Kelvin dashpot along the bond.
  double viscosity;
  /// Overstress that depends on the past of a bond; none by default.
  BondMemory memory = {};
};

/// Material of the sheet. All extensive quantities of the lattice are per unit sheet thickness h, which cancels
/// from the motion: masses in kg/m, forces in N/m, energies in J/m.
struct Material
{
  double density; ///< rho [kg/m^3], > 0
  Shell nearest;
  std::optional<Shell> next_nearest;       ///< none: a lattice of nearest neighbours alone
  Disorder disorder = {};                  ///< factors of the bonds of all shells; none by default
  std::optional<Shell> third_nearest = {}; ///< none by default

  /// A shell by its number below n_shells; nullptr where the lattice has no such bonds.
  const Shell *in_shell(std::size_t number) const
  {
    if (number == 0)
      return &nearest;
    const std::optional<Shell> &shell = number == 1 ? next_nearest : third_nearest;
    return shell ? &*shell : nullptr;
  }
  Shell *in_shell(std::size_t number) { return const_cast<Shell *>(std::as_const(*this).in_shell(number)); }

  /// Shell of a bond kind of the triangular lattice; nullptr where the lattice has no such bonds.
  const Shell *shell(std::size_t kind) const { return in_shell(shell_of(kind)); }
  /// Shell of a bond kind of a sheet; nullptr where the sheet has no such bonds.
  const Shell *shell(const TriangularLattice &lattice, std::size_t kind) const { return in_shell(lattice.shell(kind)); }

  /// Kinds of bonds that a sheet may have: the first so many.
  std::size_t n_kinds(const TriangularLattice &lattice) const
  {
    return lattice.is_triangular() && !third_nearest ? 2 * n_kinds_per_shell : lattice.n_kinds();
  }

  /// Number of mechanisms by which memories store and dissipate energy: shell after shell.
  std::size_t n_mechanisms() const { return first_mechanism(n_shells); }
  /// Number of mechanisms of the shells before one.
  std::size_t first_mechanism(std::size_t shell) const
  {
    std::size_t before = 0;
    for (std::size_t number = 0; number < shell; ++number)
      if (const Shell *other = in_shell(number))
        before += properties(other->memory).n_mechanisms;
    return before;
  }

  /// Bonds of a site inside the triangular lattice: 6 for each shell.
  unsigned int coordination() const { return 6 * (1u + (next_nearest ? 1u : 0u) + (third_nearest ? 1u : 0u)); }
  /// Bonds of a site inside a sheet, the most that scattered points may have.
  unsigned int coordination(const TriangularLattice &lattice) const
  {
    unsigned int bonds = 0;
    for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
      bonds += shell(lattice, kind) != nullptr ? 2 : 0;
    return bonds;
  }
  /// Bonds of one site, those beyond the edges included.
  unsigned int coordination(const TriangularLattice &lattice, std::size_t place) const
  {
    unsigned int bonds = 0;
    for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
      if (shell(lattice, kind) != nullptr)
        for (const Bond &bond : {lattice.bond(place, kind), lattice.bond_into(place, kind)})
          bonds += lattice.has_bond(bond.near, kind) ? 1 : 0;
    return bonds;
  }
};

/// Returns the bonds with their dashpots, but without memories.
inline Material without_memory(Material material)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material.in_shell(number))
      shell->memory = {};
  return material;
}

/// Returns the bonds without their dashpots and memories, as they are in equilibrium.
inline Material without_dashpots(Material material)
{
  for (std::size_t number = 0; number < n_shells; ++number)
    if (Shell *shell = material.in_shell(number))
      shell->viscosity = 0.;
  return without_memory(std::move(material));
}

/// A0 / h = s V / D [m], cross-section of a bond of a kind per sheet thickness; see TriangularLattice::section_length.
/// It is s (sqrt3 / 2) d for all kinds of the triangular lattice (theory.md, eq. (L.4)).
inline double cross_section(const Shell &shell, const TriangularLattice &lattice, std::size_t kind = 0)
{
  return shell.area_factor * lattice.site_area() / lattice.section_length(kind);
}

/// m / h = rho V [kg/m], (sqrt3 / 2) d^2 rho on the triangular lattice: mass of a site per sheet thickness (theory.md,
/// eq. (L.1)).
inline double site_mass(const Material &material, const TriangularLattice &lattice)
{
  return material.density * lattice.site_area();
}

} // namespace latcon::lattice
