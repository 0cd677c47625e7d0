#pragma once

#include "continuum/sheet.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

namespace latcon::continuum
{
/// Sorts unknowns and removes repetitions.
void sort_without_repetition(std::vector<dealii::types::global_dof_index> &dofs);

/// Matrix of a sheet in single precision, for iterative solvers, assembled directly. Entries are stored in blocks of
/// two by two: unknowns 2 n and 2 n + 1 belong to the same vertex, line or cell and so couple to the same unknowns. An
/// entry needs 5 bytes, of TrilinosWrappers::SparseMatrix 12.
///
/// Rounding errors of entries are relative to the stiffness between neighboring nodes and would, summed over a row, act
/// like springs to the ground, which are not small beside the stiffness against long waves. Each row therefore keeps
/// the sums of its errors, by component, and multiplies them by the displacement of its own node, so that errors see
/// only the differences between neighboring nodes. Products are accumulated in double precision.
class SinglePrecisionMatrix : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using Index = dealii::types::global_dof_index;
  using value_type = double;

  /// Entry of a matrix in global indices.
  struct Entry
  {
    Index row;
    Index column;
    double value; ///< [N/m^2]

    template <class Archive>
    void serialize(Archive &archive, unsigned int)
    {
      archive &row &column &value;
    }
  };

  /// Makes the matrix zero, with the sparsity of the tangent of `sheet` condensed by `constraints`, both of which must
  /// outlive it. Collective.
  void reinit(const Sheet &sheet, const dealii::AffineConstraints<double> &constraints);

  /// Sets all entries to `zero`, which must be 0.
  SinglePrecisionMatrix &operator=(double zero);
  /// Multiplies by a factor [-], without rounding the entries again.
  SinglePrecisionMatrix &operator*=(double factor);

  /// Adds entries [N/m^2] to a row that this rank owns or adds to, for AffineConstraints::distribute_local_to_global().
  void add(Index row, Index n_columns, const Index *columns, const double *values, bool elide_zero_values = false,
           bool columns_are_sorted = false);
  /// Leaves the diagonal of a constrained unknown zero.
  void add(Index, Index, double) {}

  /// Sends what was added to rows of other ranks. Collective.
  void compress(dealii::VectorOperation::values operation);

  /// Makes a matrix that is symmetric up to the order of its sums, and its errors, symmetric to the last bit.
  /// Collective.
  void make_symmetric();

  /// Computes y = K x for vectors over the owned unknowns of the sheet; ghost entries are ignored. Collective.
  void vmult(Vector &y, const Vector &x) const;

  /// Returns the entry (i, i) [N/m^2] of an owned row.
  double diag_element(Index i) const;

  /// Calls `visit(column, value)` for the entries [N/m^2] of a row; `row` and `column` are positions in layout().
  template <class Visit>
  void for_each_entry(const unsigned int row, const Visit &visit) const
  {
    for (std::size_t block = first_block_[row / 2]; block < first_block_[row / 2 + 1]; ++block)
      for (unsigned int c = 0; c < 2; ++c)
        visit(2 * columns_[block] + c, scale_ * values_[4 * block + 2 * (row % 2) + c]);
  }

  /// Returns the entries of the rows that are ghosts of a layout, in its order. Collective.
  std::vector<Entry> entries_of(const dealii::Utilities::MPI::Partitioner &layout) const;

  /// Layout of vectors with the unknowns of all columns, as ghosts those of other ranks.
  const dealii::Utilities::MPI::Partitioner &layout() const { return *x_.get_partitioner(); }

  Index m() const { return n_unknowns_; }
  Index n() const { return n_unknowns_; }

private:
  void set(const Entry &entry, bool adds);

  const dealii::AffineConstraints<double> *constraints_ = nullptr;
  bool is_condensed_ = false; // where entries of elements are sums, in another order than those of the transposed ones
  Index n_unknowns_ = 0;
  // Rows have the positions of the layout: those of this rank, then those of other ranks to which this rank adds.
  std::vector<std::size_t> first_block_; // per pair of rows, and the end
  std::vector<unsigned int> columns_;    // per block: pair of positions in the layout
  std::vector<float> values_;            // per block, by rows
  std::vector<float> rest_;           // per row: sums of errors of columns of its own and of the other component
  std::vector<unsigned int> partner_; // per owned row: that of the other component at the same node
  std::vector<bool> component_;       // per position
  double scale_ = 1.;                 // of stored entries
  mutable Vector x_;                  // with ghost entries
};
} // namespace latcon::continuum
