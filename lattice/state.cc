#include "lattice/state.h"

#include <Eigen/Geometry>

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
  const auto number = [&](std::size_t place)
  { return lattice.row_of(place) * (lattice.columns() + 2) + lattice.column_of(place); };
  const std::vector<std::size_t> sites = band.known_sites();
  factors.kinds.resize(lattice.n_kinds());
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
  {
    if (material.shell(lattice, kind) == nullptr)
      continue;
    Field &of_kind = factors.kinds[kind];
    of_kind = Field(lattice.n_places());
    for (const std::size_t place : sites)
    {
      of_kind[place] = distribution.factor(stream + most_kinds * number(place) + kind);
      if (scattered != nullptr)
        of_kind[place] *= scattered->weights[kind][place] / scattered->bounding_weights[kind];
    }
  }
  return factors;
}

void update_images(State &state, const RowPartition &band)
{
  for (const TriangularLattice::Image &image : band.lattice().images())
    if (band.is_relevant(image.site))
    {
      state.position.set(image.place, state.position.at(image.site) + state.periods * image.period);
      state.velocity.set(image.place, state.velocity.at(image.site));
    }
}

std::vector<std::size_t> sites_at(const TriangularLattice &lattice, const Material &material, const Edges &edges)
{
  // Sites are either on the sheet or half a spacing off.
  const double margin = 0.1 * lattice.spacing(), endless = std::numeric_limits<double>::infinity();
  const auto [periodic_x, periodic_y] = lattice.periodic();
  const double right = lattice.length(), top = 0.5 * lattice.height();
  const Eigen::AlignedBox2d sheet(Eigen::Vector2d(edges.left && !periodic_x ? -margin : -endless,
                                                  edges.bottom && !periodic_y ? -top - margin : -endless),
                                  Eigen::Vector2d(edges.right && !periodic_x ? right + margin : endless,
                                                  edges.top && !periodic_y ? top + margin : endless));
  const auto reaches_beyond = [&](std::size_t place)
  {
    const Eigen::Vector2d X = lattice.grid_point(place);
    for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
      if (const Eigen::Vector2d R = lattice.bond_vector(kind); material.shell(lattice, kind) != nullptr)
        if ((!sheet.contains(X + R) && lattice.has_bond(place, kind)) ||
            (!sheet.contains(X - R) && lattice.has_bond(lattice.bond_into(place, kind).near, kind)))
          return true;
    return false;
  };
  std::vector<std::size_t> sites;
  for (std::size_t place = 0; place < lattice.n_places(); ++place) // without a list of all, which ranks may not hold
    if (lattice.is_site(place) && reaches_beyond(place))
      sites.push_back(place);
  return sites;
}

State homogeneous_state(const RowPartition &band, const Material &material, const Eigen::Matrix2d &F, Edges edges)
{
  const TriangularLattice &lattice = band.lattice();
  const std::size_t n = lattice.n_places();
  State state;
  for (VectorField *field : {&state.position, &state.velocity, &state.acceleration})
    *field = VectorField(n);
  state.inverse_mass = Field(n);
  for (SiteFlags *marks : {&state.held, &state.rollers, &state.removed, &state.lost_bonds})
    *marks = SiteFlags(n);
  state.bonds.clear(n, material.n_kinds(lattice));

  state.periods = F;
  for (std::size_t place = 0; place < n; ++place)
    if (lattice.row_of(place) >= lattice.rows() || band.is_relevant(place)) // the margin, or a row that is known
      state.position.set(place, F * lattice.reference(place));

  state.stiffness = bond_factors(band, material, BondProperty::stiffness);
  // In all rows, as a crack tip may come to any. No other values are written in rows that are not known.
  for (const std::size_t place : sites_at(lattice, material, edges))
    state.held[place] = 1;
  const double inverse_mass = 1. / site_mass(material, lattice);
  for (const std::size_t place : band.known_sites())
  {
    for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
      if (material.shell(lattice, kind) != nullptr && lattice.has_bond(place, kind) &&
          lattice.is_occupied(lattice.bond(place, kind).far))
        state.bonds.add(place, kind);
    state.inverse_mass[place] = state.held[place] != 0 ? 0. : inverse_mass;
  }
  update_images(state, band);
  return state;
}

void add_noise(State &state, const RowPartition &band, double amplitude, std::uint64_t seed)
{
  const TriangularLattice &lattice = band.lattice();
  const std::uint64_t stream = splitmix64(seed);
  // Sites are numbered with two places between rows and before them, whatever the storage.
  for (const std::size_t place : band.known_sites())
  {
    const std::size_t number = (lattice.row_of(place) + 2) * (lattice.columns() + 4) + lattice.column_of(place) + 2;
    for (const std::size_t axis : axes)
      if (state.is_free(place, axis))
        state.position[axis][place] += amplitude * symmetric_uniform(splitmix64(stream + 2 * number + axis));
  }
  update_images(state, band);
}

void relax_memory(State &state, const RowPartition &band, const Material &material)
{
  const TriangularLattice &lattice = band.lattice();
  state.history.kinds.resize(lattice.n_kinds());
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
  {
    const Shell *shell = material.shell(lattice, kind);
    const std::size_t n = shell != nullptr ? properties(shell->memory).n_variables : 0;
    state.history.kinds[kind] = {Field(n > 0 ? lattice.n_places() : 0), {}};
    for (std::size_t v = 0; v < n; ++v)
      state.history.kinds[kind].variables.emplace_back(lattice.n_places());
  }
  if (!state.history.empty())
    for (const std::size_t row : band.rows_of_bonds())
      for_each_bond(state, lattice, {row, row + 1},
                    [&](const Bond &bond)
                    {
                      BondHistory::Kind &history = state.history.kinds[bond.kind];
                      if (!history.variables.empty())
                        history.stretch[bond.near] = stretch(state, lattice, bond);
                    });
}

double stretch(const State &state, const TriangularLattice &lattice, const Bond &bond)
{
  // The operations of the force loop, so that both agree to the last bit on whether a bond is past its limit.
  return (lattice.length_ratio(bond.near, bond.kind) * state.position.difference(bond.near, bond.far)).norm() *
         (1. / lattice.rest_length(bond.kind));
}

double stretch_rate(const State &state, const TriangularLattice &lattice, const Bond &bond, const VectorField &velocity)
{
  const Eigen::Vector2d along = state.position.difference(bond.near, bond.far);
  return lattice.length_ratio(bond.near, bond.kind) * along.dot(velocity.difference(bond.near, bond.far)) /
         (along.norm() * lattice.rest_length(bond.kind));
}

} // namespace latcon::lattice
