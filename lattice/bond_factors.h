#pragma once

#include <cstdint>
#include <vector>

#include "lattice/disorder.h"
#include "lattice/row_partition.h"

namespace latcon::lattice
{

struct Material;

/// One factor per bond, by the place where it starts; nothing is stored if all are 1.
struct BondFactors
{
  std::vector<Field> kinds; ///< by kind, empty where there are no such bonds; none: all factors are 1 [-]

  bool empty() const { return kinds.empty(); } ///< whether all factors are 1
  /// Factors of bonds of a kind from the one that starts at a place on; nullptr: all 1.
  const double *from(std::size_t place, std::size_t kind) const
  {
    return kinds.empty() || kinds[kind].empty() ? nullptr : &kinds[kind][place];
  }
  /// Factor of a bond [-].
  double of(std::size_t place, std::size_t kind) const
  {
    const double *const factor = from(place, kind);
    return factor != nullptr ? *factor : 1.;
  }
};

/// Property of a bond that disorder multiplies; the stiffness also contains the weights of scattered points.
enum class BondProperty
{
  strength,
  stiffness
};

/// Factors of a property in the rows that `band` knows, for the kinds of bonds that the material has (theory.md, eq.
/// (L.37)). The factor of a bond depends on the seed, the property and the bond alone, which is named by its row, its
/// column and its kind: the same bits for any number of ranks and threads, and whatever other shells there are.
BondFactors bond_factors(const RowPartition &band, const Material &material, BondProperty property);

} // namespace latcon::lattice
