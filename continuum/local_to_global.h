#pragma once

#include "continuum/single_precision_matrix.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <utility>
#include <vector>

class Epetra_CrsMatrix;

namespace latcon::continuum
{
/// Adds element matrices to a global matrix, condensed by constraints. Equals
/// AffineConstraints::distribute_local_to_global up to rounding, but is faster: it writes in place where no unknown of
/// the element is constrained and the row is on this rank. The matrix must be compressed afterwards.
class MatrixAssembly
{
public:
  /// `constraints` and `K` [N/m^2] must outlive this object. The sparsity of `K` must contain all added entries.
  MatrixAssembly(const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &K);

  void add(const dealii::FullMatrix<double> &local, const std::vector<dealii::types::global_dof_index> &dofs);

private:
  bool find(const int *columns, int n_columns);

  const dealii::AffineConstraints<double> &constraints_;
  Sheet::Matrix &K_;
  const Epetra_CrsMatrix &rows_;
  dealii::types::global_dof_index begin_; // of the owned rows
  dealii::types::global_dof_index end_;
  std::vector<std::pair<int, unsigned int>> order_; // columns of the current element, with their positions in it
  std::vector<int> positions_;                      // of order_ in the last searched row
};

/// Returns that to which elements add their part of a matrix K, condensed by constraints, which are those of its
/// sparsity.
inline MatrixAssembly assembly(const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &K)
{
  return MatrixAssembly(constraints, K);
}
inline SinglePrecisionMatrix &assembly(const dealii::AffineConstraints<double> &, SinglePrecisionMatrix &K)
{
  return K;
}

/// Adds element vectors to a global vector; see MatrixAssembly.
class VectorAssembly
{
public:
  VectorAssembly(const dealii::AffineConstraints<double> &constraints, Sheet::Vector &v);

  void add(const dealii::Vector<double> &local, const std::vector<dealii::types::global_dof_index> &dofs);

private:
  const dealii::AffineConstraints<double> &constraints_;
  Sheet::Vector &v_;
  double *own_;
  dealii::types::global_dof_index begin_;
  dealii::types::global_dof_index end_;
};
} // namespace latcon::continuum
