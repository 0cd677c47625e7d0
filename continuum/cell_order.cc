#include "continuum/cell_order.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

using namespace dealii;

namespace latcon::continuum
{
CellOrder::CellOrder(const Sheet &sheet) : communicator_(sheet.communicator())
{
  using CellName = CellId::binary_type;
  std::vector<CellName> own;
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      own.push_back(cell->id().to_binary<2>());
  std::vector<CellName> all;
  for (const std::vector<CellName> &of_rank : dealii::Utilities::MPI::all_gather(communicator_, own))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end());
  n_cells_ = all.size();
  for (const CellName &name : own)
    position_.push_back(std::lower_bound(all.begin(), all.end(), name) - all.begin());
}

std::vector<double> CellOrder::gather(const std::vector<double> &own) const
{
  const auto positions = dealii::Utilities::MPI::gather(communicator_, position_);
  const auto values = dealii::Utilities::MPI::gather(communicator_, own);
  std::vector<double> all;
  for (std::size_t rank = 0; rank < values.size(); ++rank)
  {
    if (positions[rank].empty())
      continue;
    const std::size_t n_per_cell = values[rank].size() / positions[rank].size();
    all.resize(n_cells_ * n_per_cell);
    for (std::size_t cell = 0; cell < positions[rank].size(); ++cell)
      std::copy_n(values[rank].begin() + cell * n_per_cell, n_per_cell,
                  all.begin() + positions[rank][cell] * n_per_cell);
  }
  return all;
}

std::vector<double> CellOrder::scatter(const std::vector<double> &all, const std::size_t n_per_cell) const
{
  if (all.size() != n_cells_ * n_per_cell)
    throw InvalidInput("a stored history has " + std::to_string(all.size()) + " values, but the sheet has " +
                       std::to_string(n_cells_) + " cells with " + std::to_string(n_per_cell) + " values each");
  std::vector<double> own;
  for (const unsigned int position : position_)
    own.insert(own.end(), all.begin() + position * n_per_cell, all.begin() + (position + 1) * n_per_cell);
  return own;
}
} // namespace latcon::continuum
