#pragma once

#include "continuum/sheet.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <utility>
#include <vector>

class Epetra_CrsMatrix;

namespace latcon::continuum
{
/// Adds what elements contribute to a matrix or a vector, condensed by constraints: the same as
/// AffineConstraints::distribute_local_to_global, rounding apart, but written in place where no unknown of the element
/// is constrained and the row is on this rank. The object written to is to be compressed afterwards.
class MatrixAssembly
{
public:
  /// Both must outlive this. The sparsity of `K` [N/m^2] must hold all that is added.
  MatrixAssembly(const dealii::AffineConstraints<double> &constraints, Sheet::Matrix &K);

  void add(const dealii::FullMatrix<double> &local, const std::vector<dealii::types::global_dof_index> &dofs);

private:
  bool find(const int *columns, int n_columns);

  const dealii::AffineConstraints<double> &constraints_;
  Sheet::Matrix &K_;
  const Epetra_CrsMatrix &rows_;
  dealii::types::global_dof_index begin_; // of the own rows
  dealii::types::global_dof_index end_;
  std::vector<std::pair<int, unsigned int>> order_; // columns of the present element, and where they are in it
  std::vector<int> positions_;                      // of order_ in the row last searched
};

/// The same for a vector.
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
