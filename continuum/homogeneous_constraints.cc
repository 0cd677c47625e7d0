#include "continuum/homogeneous_constraints.h"

#include "continuum/sheet.h"

#include <deal.II/dofs/dof_tools.h>

using namespace dealii;

namespace latcon::continuum
{
DirichletBoundaries dirichlet_boundaries(const BoundaryConditions &conditions)
{
  DirichletBoundaries held;
  for (const BoundaryField &condition : conditions.displacements)
  {
    ComponentMask mask(2, false);
    for (unsigned int i = 0; i < 2; ++i)
      mask.set(i, condition.components[i]);
    const auto [entry, is_new] = held.try_emplace(condition.boundary, mask);
    if (!is_new)
      entry->second = entry->second | mask;
  }
  return held;
}

AffineConstraints<double> homogeneous_constraints(const Sheet &sheet, const DirichletBoundaries &held)
{
  AffineConstraints<double> known(sheet.relevant());
  known.merge(sheet.conformity_constraints(), AffineConstraints<double>::no_conflicts_allowed, true);
  for (const auto &[boundary, components] : held)
    DoFTools::make_zero_boundary_constraints(sheet.dof_handler(), boundary, known, components);
  known.close(); // before sending: the receiver may not have the constraints of intermediate degrees of freedom
  return shared_constraints(known, sheet.owned(), sheet.relevant(), sheet.communicator());
}

AffineConstraints<double> shared_constraints(const AffineConstraints<double> &known, const IndexSet &owned,
                                             const IndexSet &relevant, const MPI_Comm communicator)
{
  // A rank may know the constraints of an unknown of another rank in part.
  AffineConstraints<double> shared(relevant);
  for (const auto &line : known.get_lines())
    if (owned.is_element(line.index))
    {
      shared.add_line(line.index);
      shared.add_entries(line.index, line.entries);
    }
  shared.make_consistent_in_parallel(owned, relevant, communicator);
  IndexSet storable = relevant;
  for (const auto &line : shared.get_lines())
    for (const auto &entry : line.entries)
      if (!relevant.is_element(entry.first))
        storable.add_index(entry.first);
  AffineConstraints<double> constraints(storable);
  constraints.merge(shared, AffineConstraints<double>::no_conflicts_allowed, true);
  constraints.close();
  return constraints;
}
} // namespace latcon::continuum
