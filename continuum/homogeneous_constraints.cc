#include "continuum/homogeneous_constraints.h"

#include "continuum/sheet.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_tools.h>

#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
DirichletBoundaries dirichlet_boundaries(const BoundaryConditions &conditions)
{
  DirichletBoundaries held;
  for (const PrescribedDisplacement &condition : conditions.displacements)
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
  // Each owner sends its constraints to the ranks on which they are relevant.
  using Line = std::pair<types::global_dof_index, std::vector<std::pair<types::global_dof_index, double>>>;
  const dealii::Utilities::MPI::Partitioner layout(owned, relevant, communicator);
  std::vector<Line> lines;
  for (const auto &line : known.get_lines())
    if (layout.in_local_range(line.index))
      lines.emplace_back(line.index, line.entries);

  std::vector<types::global_dof_index> wanted; // by rank 0, then rank 1, ...
  for (const auto &[begin, end] : layout.import_indices())
    for (unsigned int i = begin; i < end; ++i)
      wanted.push_back(layout.local_to_global(i));
  std::map<unsigned int, std::vector<Line>> messages;
  auto next = wanted.begin();
  for (const auto &[rank, n_wanted] : layout.import_targets())
    for (const auto end = next + n_wanted; next != end; ++next)
      if (known.is_constrained(*next))
        messages[rank].emplace_back(*next, *known.get_constraint_entries(*next));
  for (const auto &received : dealii::Utilities::MPI::some_to_some(communicator, messages))
    lines.insert(lines.end(), received.second.begin(), received.second.end());

  std::vector<types::global_dof_index> masters;
  for (const Line &line : lines)
    for (const auto &entry : line.second)
      masters.push_back(entry.first);
  std::sort(masters.begin(), masters.end());
  IndexSet storable = relevant;
  storable.add_indices(masters.begin(), std::unique(masters.begin(), masters.end()));
  AffineConstraints<double> constraints(storable);
  for (const Line &line : lines)
  {
    constraints.add_line(line.first);
    constraints.add_entries(line.first, line.second);
  }
  constraints.close();
  return constraints;
}
} // namespace latcon::continuum
