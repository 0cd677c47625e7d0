#include "continuum/homogeneous_constraints.h"

#include <deal.II/dofs/dof_tools.h>

#include <algorithm>

using namespace dealii;

namespace continuum
{
AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const HeldBoundaries &held)
{
  AffineConstraints<double> own(sheet.relevant());
  own.merge(sheet.hanging_nodes());
  for (const auto &[boundary, components] : held)
    DoFTools::make_zero_boundary_constraints(sheet.dof_handler(), boundary, own, components);
  own.close();

  // Resolved before they travel: the receiver may know nothing of the degrees of freedom in between.
  AffineConstraints<double> constraints(sheet.relevant());
  for (const auto &line : own.get_lines())
  {
    constraints.add_line(line.index);
    constraints.add_entries(line.index, line.entries);
  }
  constraints.make_consistent_in_parallel(sheet.owned(), sheet.relevant(), sheet.communicator());
  constraints.close();
  return constraints;
}

IndexSet writable_rows(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  std::vector<types::global_dof_index> masters;
  for (const auto &line : constraints.get_lines())
    for (const auto &entry : line.entries)
      masters.push_back(entry.first);
  std::sort(masters.begin(), masters.end());
  IndexSet rows = sheet.relevant();
  rows.add_indices(masters.begin(), std::unique(masters.begin(), masters.end()));
  return rows;
}
} // namespace continuum
