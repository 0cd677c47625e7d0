#include "continuum/single_precision_matrix.h"

#include "continuum/lifted_shapes.h"
#include "continuum/vector_kernels.h"
#include "support/require.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/lac/affine_constraints.templates.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
using Index = SinglePrecisionMatrix::Index;

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

// Returns the owner of each ghost entry.
std::vector<unsigned int> owners_of_ghosts(const dealii::Utilities::MPI::Partitioner &layout)
{
  std::vector<unsigned int> owners;
  for (const auto &[rank, n] : layout.ghost_targets())
    owners.insert(owners.end(), n, rank);
  return owners;
}

// Returns the pairs of unknowns to which this rank adds, each with those that it depends on.
DynamicSparsityPattern coupled_pairs(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  IndexSet rows(sheet.dof_handler().n_dofs() / 2);
  const IndexSet &lines = constraints.get_local_lines();
  for (auto interval = lines.begin_intervals(); interval != lines.end_intervals(); ++interval)
    rows.add_range(*interval->begin() / 2, interval->last() / 2 + 1);
  DynamicSparsityPattern pattern(rows.size(), rows.size(), rows);
  std::vector<Index> pairs;
  const auto insert = [&](const std::vector<Index> &dofs)
  {
    for (const Index dof : dofs)
      if (!constraints.is_constrained(dof))
        pairs.push_back(dof / 2);
      else
        for (const auto &entry : *constraints.get_constraint_entries(dof))
          pairs.push_back(entry.first / 2);
  };
  for_each_coupling(sheet, sheet.has_gradient(),
                    [&](const std::vector<Index> &dofs)
                    {
                      insert(dofs);
                      sort_without_repetition(pairs);
                      for (const Index pair : pairs)
                        pattern.add_entries(pair, pairs.begin(), pairs.end(), true);
                      pairs.clear();
                    });
  return pattern;
}
} // namespace

void sort_without_repetition(std::vector<Index> &dofs)
{
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
}

void SinglePrecisionMatrix::reinit(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  constraints_ = &constraints;
  is_condensed_ = std::any_of(constraints.get_lines().begin(), constraints.get_lines().end(),
                              [](const auto &line) { return !line.entries.empty(); });
  n_unknowns_ = sheet.dof_handler().n_dofs();
  DynamicSparsityPattern pattern = coupled_pairs(sheet, constraints);
  IndexSet owned(pattern.n_rows());
  if (!sheet.owned().is_empty())
    owned.add_range(sheet.owned().nth_index_in_set(0) / 2,
                    sheet.owned().nth_index_in_set(0) / 2 + sheet.owned().n_elements() / 2);
  SparsityTools::distribute_sparsity_pattern(pattern, owned, sheet.communicator(), pattern.row_index_set());

  std::vector<Index> foreign; // rows and columns
  for (const Index row : pattern.row_index_set())
    for (unsigned int k = 0; k < pattern.row_length(row); ++k)
      if (const Index column = pattern.column_number(row, k); !owned.is_element(column))
        foreign.push_back(column);
  sort_without_repetition(foreign);
  IndexSet ghosts(n_unknowns_);
  for (const Index pair : foreign)
    ghosts.add_range(2 * pair, 2 * pair + 2);
  x_.reinit(std::make_shared<const dealii::Utilities::MPI::Partitioner>(sheet.owned(), ghosts, sheet.communicator()));

  const unsigned int n_owned_pairs = owned.n_elements();
  const unsigned int n_pairs = n_owned_pairs + foreign.size();
  first_block_.assign(1, 0);
  columns_.clear();
  columns_.reserve(pattern.n_nonzero_elements());
  for (unsigned int row = 0; row < n_pairs; ++row)
  {
    const Index pair = layout().local_to_global(2 * row) / 2;
    if (pattern.row_index_set().is_element(pair))
      for (unsigned int k = 0; k < pattern.row_length(pair); ++k)
        columns_.push_back(layout().global_to_local(2 * pattern.column_number(pair, k)) / 2);
    std::sort(columns_.begin() + first_block_.back(), columns_.end());
    first_block_.push_back(columns_.size());
  }
  values_.resize(4 * columns_.size());
  values_.shrink_to_fit();

  // Components of unknowns, also of columns that are on no cell of this rank.
  rest_.resize(4 * n_pairs);
  partner_.resize(2 * n_owned_pairs);
  std::vector<Index> dofs(sheet.element().n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      cell->get_dof_indices(dofs);
      for (unsigned int a = 0; a < dofs.size(); ++a)
        if (layout().in_local_range(dofs[a]))
        {
          const auto [component, node] = sheet.element().system_to_component_index(a);
          const unsigned int row = layout().global_to_local(dofs[a]);
          partner_[row] =
            layout().global_to_local(dofs[sheet.element().component_to_system_index(1 - component, node)]);
          x_.local_element(row) = component;
        }
    }
  x_.update_ghost_values();
  component_.assign(x_.begin(), x_.begin() + 2 * n_pairs);
  x_.zero_out_ghost_values();
  *this = 0.;
}

SinglePrecisionMatrix &SinglePrecisionMatrix::operator=(const double zero)
{
  Assert(zero == 0., ExcNotImplemented());
  std::fill(values_.begin(), values_.end(), static_cast<float>(zero));
  std::fill(rest_.begin(), rest_.end(), static_cast<float>(zero));
  scale_ = 1.;
  return *this;
}

SinglePrecisionMatrix &SinglePrecisionMatrix::operator*=(const double factor)
{
  scale_ *= factor;
  return *this;
}

void SinglePrecisionMatrix::add(const Index row, const Index n_columns, const Index *columns, const double *values,
                                bool, bool)
{
  const unsigned int at = layout().global_to_local(row);
  const unsigned int *const begin = columns_.data() + first_block_[at / 2];
  const unsigned int *const end = columns_.data() + first_block_[at / 2 + 1];
  const unsigned int *block = begin;
  const double factor = 1. / scale_;
  double errors[2] = {0., 0.}; // of both components
  for (Index k = 0; k < n_columns; ++k)
  {
    const unsigned int column = layout().global_to_local(columns[k]);
    if (block == end || *block > column / 2) // columns of lower ranks come last in the layout
      block = begin;
    while (block != end && *block < column / 2)
      ++block;
    support::require(block != end && *block == column / 2, "a matrix has no place for an entry");
    float &entry = values_[4 * (block - columns_.data()) + 2 * (at % 2) + column % 2];
    const double exact = entry + factor * values[k];
    entry = static_cast<float>(exact);
    errors[component_[at] == component_[column] ? 0 : 1] += exact - entry;
  }
  for (unsigned int i = 0; i < 2; ++i)
    rest_[2 * at + i] += static_cast<float>(errors[i]);
}

// Sets an owned entry, and adds the error to the rest of its row.
void SinglePrecisionMatrix::set(const Entry &entry, const bool adds)
{
  const unsigned int row = layout().global_to_local(entry.row);
  const unsigned int column = layout().global_to_local(entry.column);
  const auto begin = columns_.begin() + first_block_[row / 2];
  const auto end = columns_.begin() + first_block_[row / 2 + 1];
  const auto found = std::lower_bound(begin, end, column / 2);
  support::require(found != end && *found == column / 2, "a matrix has no place for an entry");
  float &stored = values_[4 * (found - columns_.begin()) + 2 * (row % 2) + column % 2];
  const double exact = stored + (adds ? entry.value : 0.);
  stored = static_cast<float>(adds ? exact : entry.value);
  rest_[2 * row + (component_[row] == component_[column] ? 0 : 1)] += static_cast<float>(exact - stored);
}

void SinglePrecisionMatrix::compress(VectorOperation::values)
{
  constexpr Index of_own_component = numbers::invalid_dof_index; // in place of a column: rest of the row
  constexpr Index of_other_component = of_own_component - 1;
  const std::vector<unsigned int> owner = owners_of_ghosts(layout());
  const unsigned int n_owned = layout().locally_owned_size();
  std::map<unsigned int, std::vector<Entry>> messages; // by rank
  for (unsigned int row = n_owned; row < 2 * (first_block_.size() - 1); ++row)
  {
    const Index index = layout().local_to_global(row);
    std::vector<Entry> &message = messages[owner[row - n_owned]];
    for_each_entry(row,
                   [&](const unsigned int column, const double value) {
                     message.push_back({index, layout().local_to_global(column), value / scale_});
                   });
    message.push_back({index, of_own_component, rest_[2 * row]});
    message.push_back({index, of_other_component, rest_[2 * row + 1]});
  }
  std::fill(values_.begin() + 4 * first_block_[n_owned / 2], values_.end(), 0.f);
  std::fill(rest_.begin() + 2 * n_owned, rest_.end(), 0.f);
  for (const auto &received : dealii::Utilities::MPI::some_to_some(layout().get_mpi_communicator(), messages))
    for (const Entry &entry : received.second)
      if (entry.column == of_own_component || entry.column == of_other_component)
        rest_[2 * layout().global_to_local(entry.row) + (entry.column == of_own_component ? 0 : 1)] +=
          static_cast<float>(entry.value);
      else
        set(entry, true);
}

void SinglePrecisionMatrix::make_symmetric()
{
  const std::vector<unsigned int> owner = owners_of_ghosts(layout());
  const unsigned int n_owned = layout().locally_owned_size();
  std::map<unsigned int, std::vector<Entry>> messages; // by rank
  for (unsigned int row = 0; row < n_owned; ++row)
    for_each_entry(
      row,
      [&](const unsigned int column, const double value)
      {
        const Entry transposed = {layout().local_to_global(column), layout().local_to_global(row), value / scale_};
        if (column >= n_owned && transposed.row > transposed.column)
          messages[owner[column - n_owned]].push_back(transposed);
        else if (is_condensed_ && column > row && column < n_owned)
          set(transposed, false);
      });
  for (const auto &received : dealii::Utilities::MPI::some_to_some(layout().get_mpi_communicator(), messages))
    for (const Entry &entry : received.second)
      set(entry, false);
  for (unsigned int row = 0; row < n_owned; ++row)
    if (const unsigned int partner = partner_[row]; row < partner)
    {
      const bool is_free = !constraints_->is_constrained(layout().local_to_global(row)) &&
                           !constraints_->is_constrained(layout().local_to_global(partner));
      rest_[2 * row + 1] = rest_[2 * partner + 1] =
        is_free ? 0.5f * (rest_[2 * row + 1] + rest_[2 * partner + 1]) : 0.f;
    }
}

void SinglePrecisionMatrix::vmult(Vector &y, const Vector &x) const
{
  const Vector *from = &x;
  if (layout().n_mpi_processes() > 1)
  {
    std::copy(x.begin(), x.end(), x_.begin());
    x_.update_ghost_values();
    from = &x_;
  }
  const double *entries = from->begin();
  double *products = y.begin();
  const std::size_t n_owned = layout().locally_owned_size();
  multiply(first_block_.data(), n_owned / 2, columns_.data(), values_.data(), entries, products);
  for (std::size_t i = 0; i < n_owned; ++i)
    products[i] = scale_ * (products[i] + rest_[2 * i] * entries[i] + rest_[2 * i + 1] * entries[partner_[i]]);
  if (from == &x_)
    x_.zero_out_ghost_values();
}

double SinglePrecisionMatrix::diag_element(const Index i) const
{
  const unsigned int row = layout().global_to_local(i);
  double entry = rest_[2 * row];
  for_each_entry(row,
                 [&](const unsigned int column, const double value) { entry += column == row ? value / scale_ : 0.; });
  return scale_ * entry;
}

std::vector<SinglePrecisionMatrix::Entry>
SinglePrecisionMatrix::entries_of(const dealii::Utilities::MPI::Partitioner &wanted) const
{
  const std::vector<unsigned int> owner = owners_of_ghosts(wanted);
  std::map<unsigned int, std::vector<Index>> requests;
  for (unsigned int ghost = 0; ghost < owner.size(); ++ghost)
    requests[owner[ghost]].push_back(wanted.local_to_global(wanted.locally_owned_size() + ghost));
  std::map<unsigned int, std::vector<Entry>> answers;
  for (const auto &[rank, rows] : dealii::Utilities::MPI::some_to_some(layout().get_mpi_communicator(), requests))
    for (const Index row : rows)
      for_each_entry(layout().global_to_local(row),
                     [&, to = rank](const unsigned int column, const double value) {
                       answers[to].push_back({row, layout().local_to_global(column), value});
                     });
  std::vector<Entry> entries;
  for (const auto &received : dealii::Utilities::MPI::some_to_some(layout().get_mpi_communicator(), answers))
    entries.insert(entries.end(), received.second.begin(), received.second.end());
  return entries;
}
} // namespace latcon::continuum

template void dealii::AffineConstraints<double>::distribute_local_to_global(
  const dealii::FullMatrix<double> &, const dealii::Vector<double> &,
  const std::vector<dealii::types::global_dof_index> &, latcon::continuum::SinglePrecisionMatrix &,
  dealii::Vector<double> &, bool, std::integral_constant<bool, false>) const;
