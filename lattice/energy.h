#pragma once

#include "lattice/forces.h"

namespace latcon::lattice
{

// Sums over a sheet are sums over its rows, added from the lowest up, so that their bits do not depend on who moves
// which row.

/// Elastic energy of all bonds, per sheet thickness [J/m], that of their memory excluded. Collective.
double elastic_energy(const State &state, const RowPartition &band, const Material &material);

/// Energy stored in the memory of all bonds as of its last update, per sheet thickness [J/m]. Collective.
double memory_energy(const State &state, const RowPartition &band, const Material &material);

/// Energy stored by each mechanism [J/m], in the order of Material::n_mechanisms(), as of the last update, per sheet
/// thickness. Collective.
std::vector<double> memory_energies(const State &state, const RowPartition &band, const Material &material);

/// Elastic energy of one bond, that of its memory excluded [J/m].
double elastic_energy(const State &state, const TriangularLattice &lattice, const Material &material, const Bond &bond);

/// Energy in the memory of one bond [J/m].
double memory_energy(const State &state, const TriangularLattice &lattice, const Material &material, const Bond &bond);

/// Kinetic energy of all sites in the components that are free, per sheet thickness [J/m]. Collective.
double kinetic_energy(const State &state, const RowPartition &band);

/// Energy of one mechanism of the memories of bonds, such as the Maxwell branches of one relaxation time, per sheet
/// thickness [J/m]; parts of EnergyBalance::elastic and viscous.
struct MechanismEnergy
{
  double stored;     ///< as of the last update
  double dissipated; ///< since the start
};

/// Energies of a sheet and work done on it, all per sheet thickness [J/m] (theory.md, eq. (L.11)).
struct EnergyBalance
{
  double elastic;       ///< of the bonds present, stored in their memory included
  double kinetic;       ///< of the free sites
  double viscous;       ///< dissipated by the dashpots, those in the memory of bonds included, since the start
  double broken;        ///< elastic energy of bonds when they broke or were cut, kinetic energy of sites when cut out
  double contact;       ///< that contacts took from the motion since the start: stored in them or dissipated by them
  double boundary_work; ///< done on the sheet by constraints and by loads on its ends since the start
  double initial;       ///< elastic + kinetic before the seed was cut

  /// elastic + kinetic + viscous + broken + contact - initial - boundary_work; zero up to the error of the time
  /// stepping.
  double imbalance() const { return elastic + kinetic + viscous + broken + contact - initial - boundary_work; }

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("elastic", elastic);
    archive("kinetic", kinetic);
    archive("viscous", viscous);
    archive("broken", broken);
    archive("contact", contact);
    archive("boundary_work", boundary_work);
    archive("initial", initial);
  }
};

} // namespace latcon::lattice
