#include "continuum/nodal_order.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <limits>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
using CellName = CellId::binary_type;

bool is_first_rank(const Sheet &sheet)
{
  return dealii::Utilities::MPI::this_mpi_process(sheet.communicator()) == 0;
}

// Returns the position of each unknown in the order, from the cells of all ranks.
std::vector<unsigned int> positions(const std::vector<std::vector<unsigned int>> &names,
                                    const std::vector<std::vector<types::global_dof_index>> &unknowns,
                                    const unsigned int per_cell, const types::global_dof_index n_unknowns)
{
  struct Cell
  {
    CellName name;
    const types::global_dof_index *unknowns;
  };
  std::vector<Cell> cells;
  for (std::size_t rank = 0; rank < names.size(); ++rank)
    for (std::size_t c = 0; c * per_cell < unknowns[rank].size(); ++c)
    {
      Cell cell{{}, unknowns[rank].data() + c * per_cell};
      std::copy_n(names[rank].begin() + c * cell.name.size(), cell.name.size(), cell.name.begin());
      cells.push_back(cell);
    }
  std::sort(cells.begin(), cells.end(), [](const Cell &one, const Cell &two) { return one.name < two.name; });

  constexpr unsigned int none = std::numeric_limits<unsigned int>::max();
  std::vector<unsigned int> position(n_unknowns, none);
  unsigned int next = 0;
  for (const Cell &cell : cells)
    for (unsigned int a = 0; a < per_cell; ++a)
      if (unsigned int &here = position[cell.unknowns[a]]; here == none)
        here = next++;
  return position;
}
} // namespace

NodalOrder::NodalOrder(const Sheet &sheet) : sheet_(sheet)
{
  std::vector<unsigned int> names;
  std::vector<types::global_dof_index> unknowns;
  const unsigned int per_cell = sheet.element().n_dofs_per_cell();
  std::vector<types::global_dof_index> of_cell(per_cell);
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const CellName name = cell->id().to_binary<2>();
      names.insert(names.end(), name.begin(), name.end());
      cell->get_dof_indices(of_cell);
      unknowns.insert(unknowns.end(), of_cell.begin(), of_cell.end());
    }
  const MPI_Comm communicator = sheet.communicator();
  const auto all_names = dealii::Utilities::MPI::gather(communicator, names);
  const auto all_unknowns = dealii::Utilities::MPI::gather(communicator, unknowns);
  if (is_first_rank(sheet))
    position_ = positions(all_names, all_unknowns, per_cell, sheet.dof_handler().n_dofs());
  std::vector<unsigned int> of_all = dealii::Utilities::MPI::broadcast(communicator, position_);
  if (is_first_rank(sheet))
    return;
  for (const types::global_dof_index i : sheet.owned())
    position_.push_back(of_all[i]);
}

std::vector<double> NodalOrder::gather(const Sheet::Vector &x) const
{
  std::vector<double> own;
  for (const types::global_dof_index i : sheet_.owned())
    own.push_back(x(i));
  // Each rank owns a contiguous range of unknowns.
  std::vector<double> values;
  auto position = position_.begin();
  for (const std::vector<double> &of_rank : dealii::Utilities::MPI::gather(sheet_.communicator(), own))
  {
    values.resize(position_.size());
    for (const double value : of_rank)
      values[*position++] = value;
  }
  return values;
}

void NodalOrder::scatter(const std::vector<double> &values, Sheet::Vector &x) const
{
  const std::size_t n_unknowns = sheet_.dof_handler().n_dofs();
  if (values.size() != n_unknowns)
    throw InvalidInput("a stored nodal field has " + std::to_string(values.size()) + " values, but the sheet has " +
                       std::to_string(n_unknowns) + " unknowns");
  Sheet::Vector owned = sheet_.make_owned();
  auto position = position_.begin();
  for (const types::global_dof_index i : sheet_.owned())
    owned(i) = values[*position++]; // the unknowns of the root rank come first
  owned.compress(VectorOperation::insert);
  x = owned;
}
} // namespace latcon::continuum
