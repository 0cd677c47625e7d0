#include "lattice/energy.h"

namespace lattice
{

double elastic_energy(const State &state, const TriangularLattice &lattice, const Material &material)
{
  std::array<double, n_bond_kinds> volume{};
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const Shell *shell = material.shell(kind))
      volume[kind] = cross_section(*shell, lattice) * lattice.rest_length(kind);
  // Row by row: a sum over a large sheet in one go would lose the digits that small changes are seen in.
  double total = 0., row = 0.;
  std::size_t current = 0;
  for_each_bond(state, lattice,
                [&](std::size_t place, std::size_t kind, std::size_t)
                {
                  if (lattice.row_of(place) != current)
                  {
                    current = lattice.row_of(place);
                    total += row;
                    row = 0.;
                  }
                  row += volume[kind] * energy(material.shell(kind)->law, stretch(state, lattice, place, kind));
                });
  return total + row;
}

double kinetic_energy(const State &state, const TriangularLattice &lattice)
{
  double total = 0.;
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (state.inverse_mass[place] > 0.)
      total +=
        0.5 / state.inverse_mass[place] * (state.vx[place] * state.vx[place] + state.vy[place] * state.vy[place]);
  return total;
}

double boundary_power(const State &state, const Forces &forces, const Field &vx, const Field &vy)
{
  double power = 0.;
  for (std::size_t place = 0; place < state.held.size(); ++place)
    if (state.held[place] != 0)
    {
      const Eigen::Vector2d force = forces.on_site(state, vx, vy, place);
      power -= force.x() * state.vx[place] + force.y() * state.vy[place];
    }
  return power;
}

} // namespace lattice
