#include "verification/claims/gate_rows.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace latcon::claims
{
namespace
{

// Quantities behind the name of the shells. Those that depend on viscosity, on the loaded state or on which shells
// there are come besides. Verdicts of claims that no longer leave these rows are never reused, which gate_test.py would
// see.
const std::map<std::string, std::vector<std::string>> &required_rows()
{
  static const std::map<std::string, std::vector<std::string>> rows{
    {"energy",
     {": energy density, Cauchy-Born, largest relative error, 200 random F",
      ": first Piola stress, Cauchy-Born, largest relative error, 200 random F", ": mu at F = I, Cauchy-Born",
      ": lambda at F = I, Cauchy-Born", ": c_S at F = I, Cauchy-Born", ": c_L at F = I, Cauchy-Born",
      ", sinusoidal field about F = I: energy of the lattice against Bloch, worst of all fields",
      ", sinusoidal field about F = I: energy of the finite elements against their continuum, worst of all fields",
      ", sinusoidal field about F = I: order in kd to which local continuum and lattice agree",
      ", sinusoidal field about F = I: excess of the gradient continuum's energy over l_d^2 k^2 at kd = 0.05"}},
    {"wave-speeds",
     {", F = I: long-wave speed, L, lattice run against closed form, worst of 4 directions",
      ", F = I: long-wave speed, S, lattice run against closed form, worst of 4 directions",
      ", F = I: phase velocity, lattice run against Bloch, worst of all waves",
      ", F = I: phase velocity, finite elements against their continuum, worst of all waves",
      ", F = I: phase velocity at kd = 0.25, gradient continuum against Bloch, worst of all waves",
      ", F = I: order in kd of the local continuum's error, all waves together",
      ", F = I: order in kd of the gradient continuum's error, all waves together"}},
    {"intrinsic-length",
     {": alpha of L waves at 0 degrees, lattice run against closed form",
      ": alpha of S waves at 0 degrees, lattice run against closed form",
      ": alpha in all directions, Bloch against closed form",
      ": alpha in all directions, gradient continuum against closed form", ": softening: smallest alpha of any wave",
      ": intrinsic length l_d, the longest bond over sqrt(12)",
      ": shortest length with a positive gradient energy, against l_d, F = I",

      ": the same 1 % below the shortest length: negative, F = I"}},
    {"prestretch",
     {": stability of the loaded lattice, smallest w^2/k^2 of all waves over c_S^2 at F = I",
      ": mean energy density, Cauchy-Born", ": traction on the right edge, Cauchy-Born",
      ": traction on the top edge, Cauchy-Born", ": displacement, largest difference / length, Cauchy-Born",
      ": deformation gradient, largest relative difference, Cauchy-Born",
      ": first Piola stress, largest difference / largest, Cauchy-Born"}}};
  return rows;
}

} // namespace

std::string row_problem(const output::Results &results, const std::string &shells)
{
  std::set<std::pair<std::string, std::string>> decided;
  for (const output::Result &row : results.rows())
  {
    const bool is_own = required_rows().count(row.claim) > 0 && row.quantity.size() > shells.size() &&
                        row.quantity.compare(0, shells.size(), shells) == 0 &&
                        (row.quantity[shells.size()] == ':' || row.quantity[shells.size()] == ',');
    if (!is_own)
      return "`" + row.claim + "` has no row `" + row.quantity + "`";
    if (row.error && row.tolerance)
      decided.emplace(row.claim, row.quantity);
  }
  for (const auto &[claim, quantities] : required_rows())
    for (const std::string &quantity : quantities)
      if (decided.count({claim, shells + quantity}) == 0)
        return "the row `" + shells + quantity + "` of `" + claim + "` is missing";
  return "";
}

} // namespace latcon::claims
