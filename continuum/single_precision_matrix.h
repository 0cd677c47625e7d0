#pragma once

#include "continuum/sheet.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

namespace latcon::continuum
{
/// Copy of the tangent of a sheet in single precision, for smoothers, which read it many times and need at most six
/// digits. Entries are stored in blocks of two by two: unknowns 2 n and 2 n + 1 belong to the same vertex, line or cell
/// and so couple to the same unknowns. Products are accumulated in double precision, and a symmetric tangent stays
/// symmetric. Needs 5 bytes per entry, compared with 12 of the original.
class SinglePrecisionMatrix : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  /// Copies the sparsity and the entries of K [N/m^2]. Collective.
  void copy_from(const Sheet::Matrix &K);

  /// Computes y = K x for vectors over the owned degrees of freedom of the sheet; ghost entries are ignored.
  /// Collective.
  void vmult(Vector &y, const Vector &x) const;

  dealii::types::global_dof_index m() const { return n_unknowns_; }
  dealii::types::global_dof_index n() const { return n_unknowns_; }

private:
  dealii::types::global_dof_index n_unknowns_ = 0;
  std::vector<std::size_t> first_block_; // per pair of rows, and the end
  std::vector<unsigned int> columns_;    // per block: pair of entries of x_
  std::vector<float> values_;            // per block, by rows
  mutable Vector x_;                     // with the ghost entries that the owned rows need
};
} // namespace latcon::continuum
