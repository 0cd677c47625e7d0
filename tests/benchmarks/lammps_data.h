#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "lattice/simulation.h"

namespace benchmarks
{

/// Writes a sheet of linear bonds as a data file of LAMMPS: `units si`, `atom_style bond`, a sheet 1 m thick.
/// Atom type 1 is a free site, 2 a held one; bond type 1 is a nearest-neighbour bond, 2 a next-nearest one, with the
/// constants of `bond_style harmonic`, energy K (r - l)^2, K = A0 e / (2 l) [N/m].
/// @throws std::runtime_error if the file cannot be written
inline void write_lammps_data(const latcon::lattice::Simulation &simulation, const std::string &path)
{
  using namespace latcon::lattice;
  const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "w"), std::fclose);
  if (!file)
    throw std::runtime_error("cannot write " + path);
  std::FILE *const out = file.get();
  const TriangularLattice &sheet = simulation.lattice();
  const State &state = simulation.state();
  const auto number = [&](std::size_t place) { return sheet.site_number(place) + 1; };
  std::size_t n_bonds = 0;
  for_each_bond(state, sheet, [&](const Bond &) { ++n_bonds; });

  std::fprintf(out, "# A triangular lattice with linear bonds\n\n%zu atoms\n%zu bonds\n2 atom types\n2 bond types\n\n",
               sheet.n_sites(), n_bonds);
  // Wide enough for whatever the sites do.
  const double X = sheet.length(), Y = sheet.height(), d = sheet.spacing();
  std::fprintf(out, "%.17g %.17g xlo xhi\n%.17g %.17g ylo yhi\n%.17g %.17g zlo zhi\n\n", -X, 3. * X, -2. * Y, 2. * Y,
               -d, d);
  const double mass = site_mass(simulation.material(), sheet);
  std::fprintf(out, "Masses\n\n1 %.17g\n2 %.17g\n\nBond Coeffs\n\n", mass, mass);
  for (const std::size_t kind : {std::size_t{0}, n_kinds_per_shell})
  {
    const Shell &shell = *simulation.material().shell(kind);
    const double length = sheet.rest_length(kind), modulus = std::get<LinearBond>(shell.law).modulus;
    std::fprintf(out, "%d %.17g %.17g\n", kind == 0 ? 1 : 2, 0.5 * cross_section(shell, sheet) * modulus / length,
                 length);
  }
  std::fprintf(out, "\nAtoms # bond\n\n");
  for (std::size_t row = 0; row < sheet.rows(); ++row)
    for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
    {
      const std::size_t place = sheet.index(row, column);
      std::fprintf(out, "%zu 1 %d %.17g %.17g 0\n", number(place), state.held[place] ? 2 : 1, state.position.x[place],
                   state.position.y[place]);
    }
  std::fprintf(out, "\nBonds\n\n");
  std::size_t n = 0;
  for_each_bond(state, sheet,
                [&](const Bond &bond)
                {
                  std::fprintf(out, "%zu %d %zu %zu\n", ++n, bond.kind < n_kinds_per_shell ? 1 : 2, number(bond.near),
                               number(bond.far));
                });
  if (std::fflush(out) != 0 || std::ferror(out) != 0)
    throw std::runtime_error("cannot write " + path);
}

} // namespace benchmarks
