#include "lattice/energy.h"

namespace latcon::lattice
{
namespace
{

// Sum of energy(row) over the rows of a band, each by one thread.
template <class Energy>
double sum_over_rows(const RowPartition &band, const Energy &energy)
{
  std::vector<double> of_rows(band.lattice().rows(), 0.);
  for_each_row(band.lattice(), band.rows(), [&](std::size_t row) { of_rows[row] = energy(row); });
  return band.sum(of_rows);
}

// Sum of energy(state, lattice, material, bond) over all bonds.
template <class Energy>
double sum_over_bonds(const State &state, const RowPartition &band, const Material &material, const Energy &energy)
{
  const auto of_row = [&](std::size_t row)
  {
    double sum = 0.;
    for_each_bond(state, band.lattice(), {row, row + 1},
                  [&](const Bond &bond) { sum += energy(state, band.lattice(), material, bond); });
    return sum;
  };
  return sum_over_rows(band, of_row);
}

// Calls add(mechanism of the shell, energy [J/m]) for the memory of one bond.
template <class Add>
void for_each_mechanism(const State &state, const TriangularLattice &lattice, const Material &material,
                        const Bond &bond, const Add &add)
{
  const auto [place, kind, far] = bond;
  if (!state.history.remembers(kind))
    return;
  const Shell &shell = *material.shell(lattice, kind);
  const double volume =
    state.stiffness.of(place, kind) * (cross_section(shell, lattice, kind) * lattice.rest_length(kind));
  const auto variables = state.history.variables_of(place, kind);
  for (std::size_t m = 0; m < properties(shell.memory).n_mechanisms; ++m)
    add(m, volume * stored_energy(shell.memory, m, state.history.kinds[kind].stretch[place], variables.data()));
}

} // namespace

double elastic_energy(const State &state, const TriangularLattice &lattice, const Material &material, const Bond &bond)
{
  const Shell &shell = *material.shell(lattice, bond.kind);
  return state.stiffness.of(bond.near, bond.kind) *
         (cross_section(shell, lattice, bond.kind) * lattice.rest_length(bond.kind) *
          energy(shell.law, stretch(state, lattice, bond)));
}

double elastic_energy(const State &state, const RowPartition &band, const Material &material)
{
  return sum_over_bonds(state, band, material, [](const auto &...bond) { return elastic_energy(bond...); });
}

double memory_energy(const State &state, const TriangularLattice &lattice, const Material &material, const Bond &bond)
{
  double sum = 0.;
  for_each_mechanism(state, lattice, material, bond, [&](std::size_t, double energy) { sum += energy; });
  return sum;
}

double memory_energy(const State &state, const RowPartition &band, const Material &material)
{
  if (state.history.empty())
    return 0.;
  return sum_over_bonds(state, band, material, [](const auto &...bond) { return memory_energy(bond...); });
}

std::vector<double> memory_energies(const State &state, const RowPartition &band, const Material &material)
{
  const TriangularLattice &lattice = band.lattice();
  std::vector<std::vector<double>> of_rows(material.n_mechanisms(), std::vector<double>(lattice.rows(), 0.));
  if (of_rows.empty())
    return {};
  for_each_row(lattice, band.rows(),
               [&](std::size_t row)
               {
                 const auto of_bond = [&](const Bond &bond)
                 {
                   const std::size_t first = material.first_mechanism(lattice.shell(bond.kind));
                   for_each_mechanism(state, lattice, material, bond,
                                      [&](std::size_t m, double energy) { of_rows[first + m][row] += energy; });
                 };
                 for_each_bond(state, lattice, {row, row + 1}, of_bond);
               });
  std::vector<double> energies;
  for (const std::vector<double> &rows : of_rows)
    energies.push_back(band.sum(rows));
  return energies;
}

double kinetic_energy(const State &state, const RowPartition &band)
{
  const TriangularLattice &lattice = band.lattice();
  const auto of_row = [&](std::size_t row)
  {
    double sum = 0.;
    for (const std::size_t place : lattice.sites({row, row + 1}))
    {
      if (!(state.inverse_mass[place] > 0.))
        continue;
      double square = 0.;
      for (const std::size_t axis : axes)
        if (state.is_free(place, axis))
          square += state.velocity[axis][place] * state.velocity[axis][place];
      sum += 0.5 / state.inverse_mass[place] * square;
    }
    return sum;
  };
  return sum_over_rows(band, of_row);
}

} // namespace latcon::lattice
