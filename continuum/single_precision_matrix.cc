#include "continuum/single_precision_matrix.h"

#include "continuum/vector_kernels.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <Epetra_CrsMatrix.h>

#include <algorithm>
#include <numeric>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Computes y = A x by pairs of rows.
LATCON_CLONES void multiply(const std::size_t *first_block, const std::size_t n_rows, const unsigned int *columns,
                            const float *values, const double *x, double *y)
{
  for (std::size_t row = 0; row < n_rows; ++row)
  {
    Lanes sum = {0., 0., 0., 0.};
    for (std::size_t block = first_block[row]; block < first_block[row + 1]; ++block)
    {
      SingleLanes entries;
      std::memcpy(&entries, values + 4 * block, sizeof(entries));
      const double *pair = x + 2 * columns[block];
      sum += __builtin_convertvector(entries, Lanes) * Lanes{pair[0], pair[1], pair[0], pair[1]};
    }
    y[2 * row] = sum[0] + sum[1];
    y[2 * row + 1] = sum[2] + sum[3];
  }
}
} // namespace

void SinglePrecisionMatrix::copy_from(const Sheet::Matrix &K)
{
  const Epetra_CrsMatrix &matrix = K.trilinos_matrix();
  n_unknowns_ = K.m();
  const IndexSet owned = K.locally_owned_range_indices();
  const auto n_owned = static_cast<int>(owned.n_elements());
  Assert(n_owned % 2 == 0, ExcInternalError());

  // Pairs of columns, numbered as in x_, with ghosts after the owned entries.
  IndexSet ghosts(K.n());
  for (int column = 0; column < matrix.NumMyCols(); ++column)
    if (const types::global_dof_index index = matrix.GCID(column); !owned.is_element(index))
      ghosts.add_range(index / 2 * 2, index / 2 * 2 + 2);
  const auto layout =
    std::make_shared<const dealii::Utilities::MPI::Partitioner>(owned, ghosts, K.get_mpi_communicator());
  x_.reinit(layout);
  std::vector<unsigned int> position(matrix.NumMyCols());
  for (int column = 0; column < matrix.NumMyCols(); ++column)
    position[column] = layout->global_to_local(matrix.GCID(column));

  int n_entries[2];
  double *values[2];
  int *columns[2];
  std::vector<unsigned int> pairs;
  const auto extract = [&](const int row)
  {
    pairs.clear();
    for (int r = 0; r < 2; ++r)
    {
      matrix.ExtractMyRowView(row + r, n_entries[r], values[r], columns[r]);
      for (int k = 0; k < n_entries[r]; ++k)
        if (const unsigned int pair = position[columns[r][k]] / 2; pairs.empty() || pairs.back() != pair)
          pairs.push_back(pair);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  };

  // Counted first: arrays that grow would take up to twice the memory, and their number is not that of the entries,
  // since rows of constrained unknowns have fewer.
  first_block_.assign(1, 0);
  for (int row = 0; row < n_owned; row += 2)
  {
    extract(row);
    first_block_.push_back(first_block_.back() + pairs.size());
  }
  columns_.resize(first_block_.back());
  columns_.shrink_to_fit();
  values_.assign(4 * columns_.size(), 0.f);
  values_.shrink_to_fit();
  for (int row = 0; row < n_owned; row += 2)
  {
    extract(row);
    const std::size_t first = first_block_[row / 2];
    const auto last = std::copy(pairs.begin(), pairs.end(), columns_.begin() + first);
    for (int r = 0; r < 2; ++r)
    {
      std::size_t block = first;
      for (int k = 0; k < n_entries[r]; ++k)
      {
        const unsigned int at = position[columns[r][k]];
        if (block == first_block_[row / 2 + 1] || columns_[block] != at / 2)
          block = std::lower_bound(columns_.begin() + first, last, at / 2) - columns_.begin();
        values_[4 * block + 2 * r + at % 2] = static_cast<float>(values[r][k]);
      }
    }
  }
}

void SinglePrecisionMatrix::vmult(Vector &y, const Vector &x) const
{
  const Vector *from = &x;
  if (x_.get_partitioner()->n_mpi_processes() > 1)
  {
    std::copy(x.begin(), x.end(), x_.begin());
    x_.update_ghost_values();
    from = &x_;
  }
  multiply(first_block_.data(), first_block_.size() - 1, columns_.data(), values_.data(), from->begin(), y.begin());
  if (from == &x_)
    x_.zero_out_ghost_values();
}
} // namespace latcon::continuum
