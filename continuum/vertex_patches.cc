#include "continuum/vertex_patches.h"

#include "continuum/collective.h"
#include "continuum/vector_kernels.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <Eigen/Dense>

#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
constexpr unsigned int nowhere = numbers::invalid_unsigned_int;

// Writes the packed inverse of `block`, or of its replacement.
void invert(Eigen::MatrixXd &block, Eigen::LLT<Eigen::MatrixXd> &cholesky, float *packed)
{
  // Pivot relative to its diagonal entry, below which round-off determines the sign.
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
  for (Eigen::Index J = 0; J < n; J += n_lanes)
    for (Eigen::Index I = J; I < n; I += n_lanes)
      for (Eigen::Index j = J; j < J + n_lanes; ++j)
        for (Eigen::Index i = I; i < I + n_lanes; ++i)
          *packed++ = i < n && j < n ? static_cast<float>(block(std::max(i, j), std::min(i, j))) : 0.f;
}

// Computes y = A x for a symmetric matrix of n rows, a multiple of 4. `packed` contains, for each four columns, the
// blocks of 4 by 4 from the diagonal down, column by column.
inline __attribute__((always_inline)) void multiply(const float *packed, const unsigned int n, const double *x,
                                                    double *y)
{
  for (unsigned int i = 0; i < n; ++i)
    y[i] = 0.;
  for (unsigned int J = 0; J < n; J += n_lanes)
  {
    Lanes across[n_lanes] = {}; // symmetric contributions to the rows of this strip
    for (unsigned int I = J; I < n; I += n_lanes)
    {
      Lanes there;
      Lanes sum;
      std::memcpy(&there, x + I, sizeof(there));
      std::memcpy(&sum, y + I, sizeof(sum));
      for (unsigned int j = 0; j < n_lanes; ++j, packed += n_lanes)
      {
        SingleLanes entries;
        std::memcpy(&entries, packed, sizeof(entries));
        const Lanes column = __builtin_convertvector(entries, Lanes);
        sum += column * x[J + j];
        if (I > J)
          across[j] += column * there;
      }
      std::memcpy(y + I, &sum, sizeof(sum));
    }
    for (unsigned int j = 0; j < n_lanes; ++j)
      y[J + j] += (across[j][0] + across[j][1]) + (across[j][2] + across[j][3]);
  }
}

// Adds the sum over patches to z.
LATCON_CLONES void add_patches(const std::size_t n_patches, const std::size_t *first_dof, const unsigned int *dofs,
                               const std::size_t *first_entry, const float *inverses, double *work, const double *r,
                               double *z)
{
  for (std::size_t p = 0; p < n_patches; ++p)
  {
    const unsigned int *there = dofs + first_dof[p];
    const auto n = static_cast<unsigned int>(first_dof[p + 1] - first_dof[p]);
    double *patch_r = work;
    double *patch_z = work + padded_size(n);
    for (unsigned int i = 0; i < n; ++i)
      patch_r[i] = r[there[i]];
    for (unsigned int i = n; i < padded_size(n); ++i)
      patch_r[i] = 0.;
    multiply(inverses + first_entry[p], padded_size(n), patch_r, patch_z);
    for (unsigned int i = 0; i < n; ++i)
      z[there[i]] += patch_z[i];
  }
}

using Dofs = std::vector<types::global_dof_index>;

// Returns the free degrees of freedom of each patch of this rank.
std::vector<Dofs> list_patches(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  const auto &mesh = sheet.mesh();
  const unsigned int own_rank = dealii::Utilities::MPI::this_mpi_process(sheet.communicator());
  constexpr auto n_vertices = GeometryInfo<2>::vertices_per_cell;
  constexpr auto n_lines = GeometryInfo<2>::lines_per_cell;

  // A vertex belongs to the lowest rank that owns a cell with this vertex. Each such rank has all cells at the vertex,
  // at least as ghosts.
  std::vector<types::subdomain_id> owner(mesh.n_vertices(), numbers::invalid_subdomain_id);
  for (const auto &cell : mesh.active_cell_iterators())
    if (!cell->is_artificial())
      for (unsigned int v = 0; v < n_vertices; ++v)
        owner[cell->vertex_index(v)] = std::min(owner[cell->vertex_index(v)], cell->subdomain_id());

  std::vector<Dofs> patch_of(mesh.n_vertices());
  std::unordered_map<types::global_dof_index, unsigned int>
    vertex_of;                           // by name, for vertices of this rank at halved lines
  std::map<unsigned int, std::vector<std::pair<types::global_dof_index, Dofs>>> messages; // by rank: name, list
  const FESystem<2> &element = sheet.element();
  Dofs dofs(element.n_dofs_per_cell()), smaller_dofs(dofs), beyond;
  // Returns the first degree of freedom of a vertex, which identifies the vertex on all ranks.
  const auto name = [&](const unsigned int vertex) { return dofs[vertex * element.n_dofs_per_vertex()]; };
  // Add the free degrees of freedom of a part of a cell.
  const auto add = [&](const Dofs &of_cell, const unsigned int first, const unsigned int n, Dofs &to)
  {
    std::copy_if(of_cell.begin() + first, of_cell.begin() + first + n, std::back_inserter(to),
                 [&](const types::global_dof_index dof) { return !constraints.is_constrained(dof); });
  };
  const auto add_line = [&](const Dofs &of_cell, const unsigned int line, Dofs &to)
  { add(of_cell, element.get_first_line_index() + line * element.n_dofs_per_line(), element.n_dofs_per_line(), to); };
  const auto add_interior = [&](const Dofs &of_cell, Dofs &to)
  { add(of_cell, element.get_first_quad_index(), element.n_dofs_per_quad(), to); };
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
  {
    if (cell->is_artificial())
      continue;
    cell->get_dof_indices(dofs);
    for (unsigned int v = 0; v < n_vertices; ++v)
      if (owner[cell->vertex_index(v)] == own_rank && !sheet.conformity_constraints().is_constrained(name(v)))
      {
        Dofs &patch = patch_of[cell->vertex_index(v)];
        add(dofs, v * element.n_dofs_per_vertex(), element.n_dofs_per_vertex(), patch);
        for (unsigned int line = 0; line < n_lines; ++line)
          for (unsigned int end = 0; end < 2; ++end)
            if (GeometryInfo<2>::face_to_cell_vertices(line, end) == v)
              add_line(dofs, line, patch);
        add_interior(dofs, patch);
        vertex_of.emplace(name(v), cell->vertex_index(v));
      }

    // The owner of a vertex may not have the smaller cells beyond a halved line; the owner of the larger cell does.
    if (!cell->is_locally_owned())
      continue;
    for (unsigned int line = 0; line < n_lines; ++line)
      if (cell->face(line)->has_children())
      {
        const auto side = cell->face(line);
        const unsigned int middle = side->child(0)->vertex_index(1);
        beyond.clear();
        for (unsigned int half = 0; half < 2; ++half)
        {
          const auto smaller = cell->neighbor_child_on_subface(line, half);
          smaller->get_dof_indices(smaller_dofs);
          add_interior(smaller_dofs, beyond);
          for (unsigned int l = 0; l < n_lines; ++l)
            if (smaller->face(l) != side->child(half) &&
                (smaller->face(l)->vertex_index(0) == middle || smaller->face(l)->vertex_index(1) == middle))
              add_line(smaller_dofs, l, beyond);
        }
        for (unsigned int end = 0; end < 2; ++end)
        {
          const unsigned int v = GeometryInfo<2>::face_to_cell_vertices(line, end);
          if (!sheet.conformity_constraints().is_constrained(name(v)))
            messages[owner[cell->vertex_index(v)]].emplace_back(name(v), beyond);
        }
      }
  }
  const auto all_received = dealii::Utilities::MPI::some_to_some(sheet.communicator(), messages);
  run_collectively(sheet.communicator(),
                   [&]
                   {
                     for (const auto &received : all_received)
                       for (const auto &[vertex, list] : received.second)
                       {
                         Dofs &patch = patch_of[vertex_of.at(vertex)];
                         patch.insert(patch.end(), list.begin(), list.end());
                       }
                   });

  patch_of.erase(std::remove_if(patch_of.begin(), patch_of.end(), [](const Dofs &patch) { return patch.empty(); }),
                 patch_of.end());
  for (Dofs &patch : patch_of)
    sort_without_repetition(patch);
  return patch_of;
}
} // namespace

VertexPatches::VertexPatches(const Sheet &sheet, const AffineConstraints<double> &constraints)
{
  const std::vector<Dofs> patches = list_patches(sheet, constraints);

  IndexSet ghosts = sheet.relevant();
  Dofs all;
  for (const Dofs &patch : patches)
    all.insert(all.end(), patch.begin(), patch.end());
  sort_without_repetition(all);
  ghosts.add_indices(all.begin(), all.end());
  layout_ = std::make_shared<const Layout>(sheet.owned(), ghosts, sheet.communicator());

  first_dof_.assign(1, 0);
  first_entry_.assign(1, 0);
  for (const Dofs &patch : patches)
  {
    for (const types::global_dof_index dof : patch)
      dofs_.push_back(layout_->global_to_local(dof));
    first_dof_.push_back(dofs_.size());
    // The lower triangle in blocks of 4 by 4, with full diagonal blocks.
    const std::size_t n_blocks = padded_size(patch.size()) / n_lanes;
    first_entry_.push_back(first_entry_.back() + n_blocks * (n_blocks + 1) / 2 * n_lanes * n_lanes);
    largest_patch_ = std::max<std::size_t>(largest_patch_, patch.size());
  }
  inverses_.resize(first_entry_.back());
}

void VertexPatches::factorise(const SinglePrecisionMatrix &K)
{
  const std::vector<SinglePrecisionMatrix::Entry> foreign_entries = K.entries_of(*layout_);
  const unsigned int n_owned = layout_->locally_owned_size();
  const auto position_of = [&](const types::global_dof_index index)
  {
    return layout_->in_local_range(index) || layout_->is_ghost_entry(index) ? layout_->global_to_local(index) : nowhere;
  };
  run_collectively(
    layout_->get_mpi_communicator(),
    [&]
    {
      std::vector<unsigned int> of_column(K.layout().locally_owned_size() + K.layout().n_ghost_indices());
      for (unsigned int column = 0; column < of_column.size(); ++column)
        of_column[column] = position_of(K.layout().local_to_global(column));
      std::vector<std::size_t> first_foreign(layout_->n_ghost_indices(), foreign_entries.size()); // by ghost
      for (std::size_t e = foreign_entries.size(); e-- > 0;)
        first_foreign[layout_->global_to_local(foreign_entries[e].row) - n_owned] = e;

      std::vector<unsigned int> at(n_owned + layout_->n_ghost_indices(), nowhere); // position in the current patch
      Eigen::MatrixXd block;
      Eigen::LLT<Eigen::MatrixXd> cholesky;
      for (std::size_t p = 0; p + 1 < first_dof_.size(); ++p)
      {
        const unsigned int *dofs = &dofs_[first_dof_[p]];
        const unsigned int n = first_dof_[p + 1] - first_dof_[p];
        for (unsigned int i = 0; i < n; ++i)
          at[dofs[i]] = i;
        block.setZero(n, n);
        for (unsigned int i = 0; i < n; ++i)
        {
          const auto take = [&](const unsigned int position, const double value)
          {
            if (position != nowhere && at[position] != nowhere)
              block(at[position], i) = value;
          };
          if (dofs[i] < n_owned)
          {
            K.for_each_entry(dofs[i],
                             [&](const unsigned int column, const double value) { take(of_column[column], value); });
            continue;
          }
          const types::global_dof_index row = layout_->local_to_global(dofs[i]);
          for (std::size_t e = first_foreign[dofs[i] - n_owned];
               e < foreign_entries.size() && foreign_entries[e].row == row; ++e)
            take(position_of(foreign_entries[e].column), foreign_entries[e].value);
        }
        invert(block, cholesky, &inverses_[first_entry_[p]]);
        for (unsigned int i = 0; i < n; ++i)
          at[dofs[i]] = nowhere;
      }
    });
}

void VertexPatches::vmult(Vector &z, const Vector &r) const
{
  z = 0.;
  r.update_ghost_values();
  std::vector<double> work(2 * padded_size(largest_patch_));
  add_patches(first_dof_.size() - 1, first_dof_.data(), dofs_.data(), first_entry_.data(), inverses_.data(),
              work.data(), r.begin(), z.begin());
  r.zero_out_ghost_values();
  z.compress(VectorOperation::add);
}
} // namespace latcon::continuum
