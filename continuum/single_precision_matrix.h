#pragma once

#include "continuum/sheet.h"

#include <deal.II/base/subscriptor.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

namespace latcon::continuum
{
/// A copy of the tangent of a sheet for smoothers, which read it many times and need no more than six digits of it: its
/// entries are rounded to single precision and stored in blocks of two by two, the unknowns 2 n and 2 n + 1, which are
/// at the same vertex, line or cell and so couple to the same others. Products are summed in double precision, and a
/// symmetric tangent stays symmetric. 5 bytes an entry against 12 of the original.
class SinglePrecisionMatrix : public dealii::Subscriptor
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  /// Takes the entries of K [N/m^2]; the sparsity is that of K then. Collective.
  void copy_from(const Sheet::Matrix &K);

  /// y = K x. Both have the owned degrees of freedom of the sheet; ghost entries are not looked at. Collective.
  void vmult(Vector &y, const Vector &x) const;

  dealii::types::global_dof_index m() const { return n_unknowns_; }
  dealii::types::global_dof_index n() const { return n_unknowns_; }

private:
  dealii::types::global_dof_index n_unknowns_ = 0;
  std::vector<std::size_t> first_block_; // of each pair of rows, and the end
  std::vector<unsigned int> columns_;    // of each block, a pair of entries of x_
  std::vector<float> values_;            // of each block, by rows
  mutable Vector x_;                     // with the ghost entries that the owned rows need
};
} // namespace latcon::continuum
