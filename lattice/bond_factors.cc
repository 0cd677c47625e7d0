#include "lattice/bond_factors.h"

#include "lattice/counter_hash.h"
#include "lattice/material.h"

namespace latcon::lattice
{

BondFactors bond_factors(const RowPartition &band, const Material &material, BondProperty property)
{
  const bool is_strength = property == BondProperty::strength;
  const Distribution &distribution = is_strength ? material.disorder.strength : material.disorder.stiffness;
  BondFactors factors;
  const TriangularLattice &lattice = band.lattice();
  const ScatteredBonds *const scattered = is_strength ? nullptr : lattice.scattered();
  if (distribution.is_none() && scattered == nullptr)
    return factors;
  const std::uint64_t stream = splitmix64(splitmix64(material.disorder.seed) + (is_strength ? 1 : 2));
  // Further shells of the lattice do not change the factors of others.
  const std::uint64_t most_kinds = lattice.is_triangular() ? 16 : TriangularLattice::most_kinds;
  // Sites are numbered with two places between rows, whatever the storage.
  const auto number = [&](std::size_t row, std::size_t column) { return row * (lattice.columns() + 2) + column; };
  const std::vector<std::size_t> rows = band.known_rows();
  factors.kinds.resize(lattice.n_kinds());
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
  {
    if (material.shell(lattice, kind) == nullptr)
      continue;
    Field &of_kind = factors.kinds[kind];
    of_kind = Field(lattice.n_places());
    for (const std::size_t row : rows)
      for (std::size_t column = 0; column < lattice.sites_in_row(row); ++column)
      {
        const std::size_t place = lattice.index(row, column);
        of_kind[place] = distribution.factor(stream + most_kinds * number(row, column) + kind);
        if (scattered != nullptr)
          of_kind[place] *= scattered->weights[kind][place] / scattered->bounding_weights[kind];
      }
  }
  return factors;
}

} // namespace latcon::lattice
