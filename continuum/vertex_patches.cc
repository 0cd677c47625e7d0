#include "continuum/vertex_patches.h"

#include "continuum/collective.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <Eigen/Dense>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace dealii;

namespace continuum
{
namespace
{
constexpr unsigned int nowhere = numbers::invalid_unsigned_int;

// Entries of a lower triangle of n rows.
std::size_t packed_size(const std::size_t n)
{
  return n * (n + 1) / 2;
}

// Lower triangle of the inverse of `block`, column by column; false if the block had to be replaced.
bool invert(Eigen::MatrixXd &block, Eigen::LLT<Eigen::MatrixXd> &cholesky, double *packed)
{
  // Of the pivot, relative to the diagonal entry it came from: below it, round-off decides about the sign.
  constexpr double smallest_pivot = 1e-12;
  const Eigen::Index n = block.rows();
  bool is_safe = block.allFinite();
  if (is_safe)
  {
    cholesky.compute(block);
    is_safe = cholesky.info() == Eigen::Success;
    for (Eigen::Index i = 0; is_safe && i < n; ++i)
    {
      const double pivot = cholesky.matrixLLT()(i, i);
      is_safe = pivot * pivot > smallest_pivot * block(i, i);
    }
  }
  if (is_safe)
    block = cholesky.solve(Eigen::MatrixXd::Identity(n, n));
  else
  {
    const Eigen::VectorXd row_sums = block.cwiseAbs().rowwise().sum();
    block.setZero();
    for (Eigen::Index i = 0; i < n; ++i)
      block(i, i) = row_sums(i) > 0. && std::isfinite(row_sums(i)) ? 1. / row_sums(i) : 0.;
  }
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i)
      *packed++ = block(i, j);
  return is_safe;
}

// y += A x for a symmetric matrix of which `packed` is the lower triangle, column by column.
void add_product(const double *packed, const unsigned int n, const double *x, double *y)
{
  using Segment = Eigen::Map<const Eigen::VectorXd>;
  for (unsigned int j = 0; j < n; ++j)
  {
    const unsigned int below = n - j - 1;
    const Segment column(packed + 1, below);
    y[j] += packed[0] * x[j] + column.dot(Segment(x + j + 1, below));
    Eigen::Map<Eigen::VectorXd>(y + j + 1, below) += column * x[j];
    packed += below + 1;
  }
}
} // namespace

VertexPatches::VertexPatches(const Sheet &sheet, const AffineConstraints<double> &constraints,
                             std::shared_ptr<const Layout> layout)
  : layout_(std::move(layout))
{
  collectively(sheet.communicator(), [&] { list_patches(sheet, constraints); });

  const unsigned int n_owned = layout_->locally_owned_size();
  std::vector<bool> is_needed(layout_->n_ghost_indices(), false);
  for (const unsigned int dof : dofs_)
    if (dof >= n_owned)
      is_needed[dof - n_owned] = true;
  std::vector<int> rows;
  for (unsigned int ghost = 0; ghost < is_needed.size(); ++ghost)
    if (is_needed[ghost])
      rows.push_back(static_cast<int>(layout_->local_to_global(n_owned + ghost)));
  ghost_rows_ = std::make_unique<Epetra_Map>(-1, static_cast<int>(rows.size()), rows.data(), 0,
                                             Epetra_MpiComm(sheet.communicator()));
}

VertexPatches::~VertexPatches() = default;

void VertexPatches::list_patches(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  const auto &mesh = sheet.mesh();
  const auto &element = sheet.element();
  const unsigned int own_rank = Utilities::MPI::this_mpi_process(sheet.communicator());
  constexpr auto n_vertices = GeometryInfo<2>::vertices_per_cell;
  constexpr auto n_lines = GeometryInfo<2>::lines_per_cell;

  // A vertex belongs to the lowest rank that owns a cell with that vertex; each of these ranks sees all such cells.
  std::vector<types::subdomain_id> owner(mesh.n_vertices(), numbers::invalid_subdomain_id);
  for (const auto &cell : mesh.active_cell_iterators())
    if (!cell->is_artificial())
      for (unsigned int v = 0; v < n_vertices; ++v)
        owner[cell->vertex_index(v)] = std::min(owner[cell->vertex_index(v)], cell->subdomain_id());

  std::vector<std::vector<unsigned int>> dofs_of(mesh.n_vertices());
  std::vector<types::global_dof_index> cell_dofs(element.n_dofs_per_cell());
  const auto add = [&](std::vector<unsigned int> &patch, const unsigned int first, const unsigned int n)
  {
    for (unsigned int a = first; a < first + n; ++a)
      if (!constraints.is_constrained(cell_dofs[a]))
        patch.push_back(layout_->global_to_local(cell_dofs[a]));
  };
  const auto add_line = [&](std::vector<unsigned int> &patch, const unsigned int line)
  { add(patch, element.get_first_line_index() + line * element.n_dofs_per_line(), element.n_dofs_per_line()); };
  const auto add_interior = [&](std::vector<unsigned int> &patch)
  { add(patch, element.get_first_quad_index(), element.n_dofs_per_quad()); };

  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
  {
    if (cell->is_artificial())
      continue;
    cell->get_dof_indices(cell_dofs);
    for (unsigned int v = 0; v < n_vertices; ++v)
      if (owner[cell->vertex_index(v)] == own_rank)
      {
        std::vector<unsigned int> &patch = dofs_of[cell->vertex_index(v)];
        add(patch, v * element.n_dofs_per_vertex(), element.n_dofs_per_vertex());
        for (unsigned int line = 0; line < n_lines; ++line)
          for (unsigned int end = 0; end < 2; ++end)
            if (GeometryInfo<2>::face_to_cell_vertices(line, end) == v)
              add_line(patch, line);
        add_interior(patch);
      }
    for (unsigned int line = 0; line < n_lines; ++line)
      if (cell->face(line)->has_children())
      {
        const unsigned int middle = cell->face(line)->child(0)->vertex_index(1);
        if (owner[middle] == own_rank)
        {
          add_line(dofs_of[middle], line);
          add_interior(dofs_of[middle]);
        }
      }
  }

  first_dof_.assign(1, 0);
  std::size_t n_entries = 0;
  for (std::vector<unsigned int> &patch : dofs_of)
    if (!patch.empty())
    {
      std::sort(patch.begin(), patch.end());
      patch.erase(std::unique(patch.begin(), patch.end()), patch.end());
      dofs_.insert(dofs_.end(), patch.begin(), patch.end());
      first_dof_.push_back(dofs_.size());
      n_entries += packed_size(patch.size());
    }
  inverses_.resize(n_entries);
}

void VertexPatches::factorise(const Sheet::Matrix &K)
{
  const Epetra_CrsMatrix &own = K.trilinos_matrix();
  Epetra_CrsMatrix ghosts(Copy, *ghost_rows_, 0);
  if (ghosts.Import(own, Epetra_Import(*ghost_rows_, own.RowMap()), Insert) < 0)
    throw std::runtime_error("rows of the tangent could not be exchanged");

  own_replaced_ = 0;
  const unsigned int n_owned = layout_->locally_owned_size();
  const auto position_of = [&](const int column)
  {
    const auto index = static_cast<types::global_dof_index>(column);
    return layout_->in_local_range(index) || layout_->is_ghost_entry(index) ? layout_->global_to_local(index) : nowhere;
  };
  collectively(layout_->get_mpi_communicator(),
               [&]
               {
                 std::vector<unsigned int> own_columns(own.NumMyCols());
                 for (int column = 0; column < own.NumMyCols(); ++column)
                   own_columns[column] = position_of(own.GCID(column));

                 std::vector<unsigned int> at(n_owned + layout_->n_ghost_indices(), nowhere); // in the present patch
                 Eigen::MatrixXd block;
                 Eigen::LLT<Eigen::MatrixXd> cholesky;
                 double *inverse = inverses_.data();
                 for (std::size_t p = 0; p + 1 < first_dof_.size(); ++p)
                 {
                   const unsigned int *dofs = &dofs_[first_dof_[p]];
                   const unsigned int n = first_dof_[p + 1] - first_dof_[p];
                   for (unsigned int i = 0; i < n; ++i)
                     at[dofs[i]] = i;
                   block.setZero(n, n);
                   int n_entries = 0;
                   double *values = nullptr;
                   int *columns = nullptr;
                   for (unsigned int i = 0; i < n; ++i)
                   {
                     const auto take = [&](const int k, const unsigned int position)
                     {
                       if (position != nowhere && at[position] != nowhere)
                         block(at[position], i) = values[k];
                     };
                     if (dofs[i] < n_owned)
                     {
                       own.ExtractMyRowView(static_cast<int>(dofs[i]), n_entries, values, columns);
                       for (int k = 0; k < n_entries; ++k)
                         take(k, own_columns[columns[k]]);
                     }
                     else
                     {
                       ghosts.ExtractGlobalRowView(static_cast<int>(layout_->local_to_global(dofs[i])), n_entries,
                                                   values, columns);
                       for (int k = 0; k < n_entries; ++k)
                         take(k, position_of(columns[k]));
                     }
                   }
                   if (!invert(block, cholesky, inverse))
                     ++own_replaced_;
                   inverse += packed_size(n);
                   for (unsigned int i = 0; i < n; ++i)
                     at[dofs[i]] = nowhere;
                 }
               });
}

void VertexPatches::vmult(Vector &z, const Vector &r) const
{
  z = 0.;
  r.update_ghost_values();
  std::vector<double> patch_r;
  std::vector<double> patch_z;
  const double *inverse = inverses_.data();
  for (std::size_t p = 0; p + 1 < first_dof_.size(); ++p)
  {
    const unsigned int *dofs = &dofs_[first_dof_[p]];
    const unsigned int n = first_dof_[p + 1] - first_dof_[p];
    patch_r.resize(n);
    for (unsigned int i = 0; i < n; ++i)
      patch_r[i] = r.local_element(dofs[i]);
    patch_z.assign(n, 0.);
    add_product(inverse, n, patch_r.data(), patch_z.data());
    for (unsigned int i = 0; i < n; ++i)
      z.local_element(dofs[i]) += patch_z[i];
    inverse += packed_size(n);
  }
  r.zero_out_ghost_values();
  z.compress(VectorOperation::add);
}

unsigned int VertexPatches::n_replaced() const
{
  return Utilities::MPI::sum(own_replaced_, layout_->get_mpi_communicator());
}
} // namespace continuum
