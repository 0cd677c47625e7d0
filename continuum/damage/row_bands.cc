#include "continuum/damage/row_bands.h"

#include "continuum/errors.h"

#include <algorithm>
#include <string>

namespace latcon::continuum
{
namespace
{
// First row of a band.
std::size_t first_row(const std::size_t rows, const int rank, const int n_ranks)
{
  return rows * static_cast<std::size_t>(rank) / static_cast<std::size_t>(n_ranks);
}
} // namespace

RowBands::RowBands(const NodeGrid &grid, MPI_Comm communicator)
  : communicator_(communicator), rows_(grid.rows()), end_(grid.rows())
{
  if (communicator == MPI_COMM_SELF)
    return; // also in programs without MPI
  MPI_Comm_rank(communicator, &rank_);
  MPI_Comm_size(communicator, &n_ranks_);
  if (static_cast<std::size_t>(n_ranks_) > rows_)
    throw InvalidInput("the sheet has " + std::to_string(rows_) + " rows of nodes, fewer than the " +
                       std::to_string(n_ranks_) + " ranks");
  begin_ = first_row(rows_, rank_, n_ranks_);
  end_ = first_row(rows_, rank_ + 1, n_ranks_);
}

void RowBands::gather(std::vector<double> &values, const std::size_t n_rows) const
{
  if (n_ranks_ == 1)
    return;
  const std::size_t per_row = values.size() / n_rows;
  std::vector<int> counts, offsets;
  for (int rank = 0; rank < n_ranks_; ++rank)
  {
    const std::size_t first = std::min(first_row(rows_, rank, n_ranks_), n_rows);
    const std::size_t last = std::min(first_row(rows_, rank + 1, n_ranks_), n_rows);
    offsets.push_back(static_cast<int>(first * per_row));
    counts.push_back(static_cast<int>((last - first) * per_row));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values.data(), counts.data(), offsets.data(), MPI_DOUBLE,
                 communicator_);
}
} // namespace latcon::continuum
