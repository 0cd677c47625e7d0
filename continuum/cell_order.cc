#include "continuum/cell_order.h"

#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>

#include <algorithm>
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
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
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
    ranges_.push_back({begins[name], own[name]});
}

std::vector<double> CellOrder::gather(const std::vector<double> &own) const
{
  const auto ranges = dealii::Utilities::MPI::gather(communicator_, ranges_);
  const auto values = dealii::Utilities::MPI::gather(communicator_, own);
  std::vector<double> all(ranges.empty() ? 0 : n_values_);
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

std::vector<double> CellOrder::scatter(const std::vector<double> &all) const
{
  if (all.size() != n_values_)
    throw InvalidInput("a stored history has " + std::to_string(all.size()) + " values, but that of the sheet has " +
                       std::to_string(n_values_));
  std::vector<double> own;
  for (const auto &[begin, size] : ranges_)
    own.insert(own.end(), all.begin() + begin, all.begin() + begin + size);
  return own;
}
} // namespace latcon::continuum
