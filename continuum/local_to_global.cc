#include "continuum/local_to_global.h"

#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>

#include <algorithm>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
bool has_constrained(const AffineConstraints<double> &constraints, const std::vector<types::global_dof_index> &dofs)
{
  return std::any_of(dofs.begin(), dofs.end(), [&](const auto dof) { return constraints.is_constrained(dof); });
}
} // namespace

MatrixAssembly::MatrixAssembly(const AffineConstraints<double> &constraints, Sheet::Matrix &K)
  : constraints_(constraints), K_(K), rows_(K.trilinos_matrix()), begin_(K.local_range().first),
    end_(K.local_range().second)
{
}

// Finds the positions of the columns of the element in a row; returns false if one is missing. The rows of a vertex,
// line or cell have the same columns, so the last positions are tried first.
bool MatrixAssembly::find(const int *columns, const int n_columns)
{
  const std::size_t n = order_.size();
  bool is_as_before = positions_.size() == n && positions_.back() < n_columns;
  for (std::size_t k = 0; is_as_before && k < n; ++k)
    is_as_before = columns[positions_[k]] == order_[k].first;
  if (is_as_before)
    return true;
  positions_.resize(n);
  int position = 0;
  for (std::size_t k = 0; k < n; ++k)
  {
    while (position < n_columns && columns[position] < order_[k].first)
      ++position;
    if (position == n_columns || columns[position] != order_[k].first)
    {
      positions_.clear();
      return false;
    }
    positions_[k] = position;
  }
  return true;
}

void MatrixAssembly::add(const FullMatrix<double> &local, const std::vector<types::global_dof_index> &dofs)
{
  if (has_constrained(constraints_, dofs))
  {
    constraints_.distribute_local_to_global(local, dofs, K_);
    return;
  }
  order_.clear();
  positions_.clear();
  for (unsigned int b = 0; b < dofs.size(); ++b)
    order_.emplace_back(rows_.LCID(static_cast<int>(dofs[b])), b);
  std::sort(order_.begin(), order_.end());
  for (unsigned int a = 0; a < dofs.size(); ++a)
  {
    int n_columns = 0;
    double *values = nullptr;
    int *columns = nullptr;
    if (dofs[a] >= begin_ && dofs[a] < end_)
      rows_.ExtractMyRowView(static_cast<int>(dofs[a] - begin_), n_columns, values, columns);
    if (values == nullptr || !find(columns, n_columns))
    {
      K_.add(dofs[a], dofs.size(), dofs.data(), &local(a, 0), false);
      continue;
    }
    const double *row = &local(a, 0);
    for (std::size_t k = 0; k < order_.size(); ++k)
      values[positions_[k]] += row[order_[k].second];
  }
}

VectorAssembly::VectorAssembly(const AffineConstraints<double> &constraints, Sheet::Vector &v)
  : constraints_(constraints), v_(v), own_(v.trilinos_vector()[0]), begin_(v.local_range().first),
    end_(v.local_range().second)
{
}

void VectorAssembly::add(const Vector<double> &local, const std::vector<types::global_dof_index> &dofs)
{
  const bool is_own =
    std::all_of(dofs.begin(), dofs.end(), [&](const auto dof) { return dof >= begin_ && dof < end_; });
  if (!is_own || has_constrained(constraints_, dofs))
  {
    constraints_.distribute_local_to_global(local, dofs, v_);
    return;
  }
  for (unsigned int a = 0; a < dofs.size(); ++a)
    own_[dofs[a] - begin_] += local[a];
}
} // namespace latcon::continuum
