#include "continuum/cell_order.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/filtered_iterator.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

using namespace dealii;

namespace latcon::continuum
{
CellOrder::CellOrder(const Sheet &sheet, const std::vector<std::size_t> &n_values) : communicator_(sheet.communicator())
{
  using Sizes = std::map<CellId::binary_type, std::size_t>; // sorted by the names of cells
  Sizes own;
  std::vector<CellId::binary_type> names;
  for (const auto &cell : sheet.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
  {
    names.push_back(cell->id().to_binary<2>());
    own[names.back()] = n_values[names.size() - 1];
  }
  Sizes begins; // sizes at first
  for (Sizes &of_rank : dealii::Utilities::MPI::all_gather(communicator_, own))
    begins.merge(of_rank);
  for (auto &[name, begin] : begins)
    n_values_ += std::exchange(begin, n_values_);
  for (const CellId::binary_type &name : names)
    ranges_.emplace_back(begins[name], own[name]);
}

template <class Value>
std::vector<Value> CellOrder::gather(const std::vector<Value> &own) const
{
  const auto ranges = dealii::Utilities::MPI::gather(communicator_, ranges_);
  const auto values = dealii::Utilities::MPI::gather(communicator_, own);
  std::vector<Value> all(ranges.empty() ? 0 : n_values_);
  for (std::size_t rank = 0; rank < values.size(); ++rank)
  {
    auto next = values[rank].begin();
    for (const auto &[begin, size] : ranges[rank])
    {
      std::copy_n(next, size, all.begin() + begin);
      next += size;
    }
  }
  return all;
}

template std::vector<double> CellOrder::gather(const std::vector<double> &) const;

std::vector<double> CellOrder::scatter(const std::vector<double> &all) const
{
  require(all.size() == n_values_, "a stored history has " + std::to_string(all.size()) +
                                     " values, but that of the sheet has " + std::to_string(n_values_));
  std::vector<double> own;
  for (const auto &[begin, size] : ranges_)
    own.insert(own.end(), all.begin() + begin, all.begin() + begin + size);
  return own;
}

NodalOrder::NodalOrder(const Sheet &sheet) : sheet_(sheet)
{
  std::vector<types::global_dof_index> own, of_cell(sheet.element().n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
  {
    cell->get_dof_indices(of_cell);
    own.insert(own.end(), of_cell.begin(), of_cell.end());
  }
  const CellOrder cells(sheet, std::vector<std::size_t>(own.size() / of_cell.size(), of_cell.size()));
  constexpr unsigned int none = std::numeric_limits<unsigned int>::max();
  std::vector<unsigned int> position(sheet.dof_handler().n_dofs(), none);
  unsigned int next = 0;
  for (const types::global_dof_index i : cells.gather(own)) // empty on other ranks than the root
    if (position[i] == none)
      position[i] = next++;
  position_ = dealii::Utilities::MPI::broadcast(sheet.communicator(), position);
}

std::vector<double> NodalOrder::gather(const Sheet::Vector &x) const
{
  const Sheet::Vector owned = sheet_.without_ghosts(x);
  const std::vector<double> own(owned.begin(), owned.end());
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
  require(values.size() == position_.size(), "a stored nodal field has " + std::to_string(values.size()) +
                                               " values, but the sheet has " + std::to_string(position_.size()) +
                                               " unknowns");
  Sheet::Vector owned = sheet_.make_owned();
  for (const types::global_dof_index i : sheet_.owned())
    owned(i) = values[position_[i]];
  owned.compress(VectorOperation::insert);
  x = owned;
}
} // namespace latcon::continuum
