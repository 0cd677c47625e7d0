#pragma once

// Linear forms and meshes for tests of multigrid.

#include "continuum/multigrid.h"
#include "sheets.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_interface_values.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/meshworker/mesh_loop.h>

namespace multigrid_cases
{
using namespace sheets;
using dealii::AffineConstraints;
using latcon::continuum::Multigrid;
using latcon::continuum::Sheet;

/// Linear form of strain-gradient elasticity, Grad u : Grad v + l^2 Grad Grad u : Grad Grad v, with an interior penalty
/// on jumps of the normal derivative: fourth-order operator and face terms.
class GradientForm
{
public:
  explicit GradientForm(const double internal_length) : square_(internal_length * internal_length) {}

  void make_matrix(const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Matrix &K) const
  {
    dealii::TrilinosWrappers::SparsityPattern pattern(sheet.owned(), sheet.owned(), constraints.get_local_lines(),
                                                      sheet.communicator());
    const auto rank = dealii::Utilities::MPI::this_mpi_process(sheet.communicator());
    if (square_ > 0.)
      dealii::DoFTools::make_flux_sparsity_pattern(sheet.dof_handler(), pattern, constraints, false, rank);
    else
      dealii::DoFTools::make_sparsity_pattern(sheet.dof_handler(), pattern, constraints, false, rank);
    pattern.compress();
    K.reinit(pattern);
  }

  void assemble(const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Matrix &K) const
  {
    using dealii::FullMatrix;
    using dealii::Tensor;
    struct Scratch
    {
      Scratch(const Sheet &sheet)
        : cell(sheet.mapping(), sheet.element(), dealii::QGauss<2>(sheet.degree() + 1),
               dealii::update_gradients | dealii::update_hessians | dealii::update_JxW_values),
          face(sheet.mapping(), sheet.element(), dealii::QGauss<1>(sheet.degree() + 1),
               dealii::update_gradients | dealii::update_hessians | dealii::update_JxW_values |
                 dealii::update_normal_vectors)
      {
      }
      Scratch(const Scratch &other)
        : cell(other.cell.get_mapping(), other.cell.get_fe(), other.cell.get_quadrature(),
               other.cell.get_update_flags()),
          face(other.face.get_mapping(), other.face.get_fe(), other.face.get_quadrature(),
               other.face.get_update_flags())
      {
      }
      dealii::FEValues<2> cell;
      dealii::FEInterfaceValues<2> face;
    };
    struct Block
    {
      FullMatrix<double> values;
      std::vector<dealii::types::global_dof_index> dofs;
    };
    struct Blocks
    {
      Block cell;
      std::vector<Block> faces;
    };

    const auto &element = sheet.element();
    const unsigned int p = sheet.degree();
    K = 0.;
    const auto on_cell = [&](const auto &cell, Scratch &scratch, Blocks &blocks)
    {
      const unsigned int n = element.n_dofs_per_cell();
      scratch.cell.reinit(cell);
      blocks.faces.clear();
      blocks.cell.values.reinit(n, n);
      blocks.cell.dofs.resize(n);
      cell->get_dof_indices(blocks.cell.dofs);
      for (unsigned int q = 0; q < scratch.cell.n_quadrature_points; ++q)
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            if (element.system_to_component_index(i).first == element.system_to_component_index(j).first)
              blocks.cell.values(i, j) +=
                (scratch.cell.shape_grad(i, q) * scratch.cell.shape_grad(j, q) +
                 square_ * scalar_product(scratch.cell.shape_hessian(i, q), scratch.cell.shape_hessian(j, q))) *
                scratch.cell.JxW(q);
    };
    const auto on_face = [&](const auto &cell, const unsigned int f, const unsigned int sf, const auto &neighbour,
                             const unsigned int nf, const unsigned int nsf, Scratch &scratch, Blocks &blocks)
    {
      auto &face = scratch.face;
      face.reinit(cell, f, sf, neighbour, nf, nsf);
      const unsigned int n = face.n_current_interface_dofs();
      blocks.faces.emplace_back();
      Block &block = blocks.faces.back();
      block.values.reinit(n, n);
      block.dofs = face.get_interface_dof_indices();
      const double h = std::min(cell->extent_in_direction(f / 2), neighbour->extent_in_direction(nf / 2));
      const double penalty = 2. * p * (p + 1) / h;
      std::vector<unsigned int> component(n);
      std::vector<double> jump(n);
      std::vector<double> average(n);
      for (unsigned int i = 0; i < n; ++i)
      {
        const auto pair = face.interface_dof_to_dof_indices(i);
        component[i] =
          element.system_to_component_index(pair[0] != dealii::numbers::invalid_unsigned_int ? pair[0] : pair[1]).first;
      }
      for (unsigned int q = 0; q < face.get_quadrature().size(); ++q)
      {
        const Tensor<1, 2> normal = face.normal(q);
        for (unsigned int i = 0; i < n; ++i)
        {
          jump[i] = face.jump_in_shape_gradients(i, q, component[i]) * normal;
          average[i] = normal * (face.average_of_shape_hessians(i, q, component[i]) * normal);
        }
        const double weight = square_ * face.JxW(q);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            if (component[i] == component[j])
              block.values(i, j) +=
                weight * (penalty * jump[i] * jump[j] - average[i] * jump[j] - jump[i] * average[j]);
      }
    };
    const auto copy = [&](const Blocks &blocks)
    {
      constraints.distribute_local_to_global(blocks.cell.values, blocks.cell.dofs, K);
      for (const Block &block : blocks.faces)
        constraints.distribute_local_to_global(block.values, block.dofs, K);
    };
    using namespace dealii::MeshWorker;
    if (square_ > 0.)
      mesh_loop(sheet.dof_handler().active_cell_iterators(), on_cell, copy, Scratch(sheet), Blocks(),
                assemble_own_cells | assemble_own_interior_faces_once | assemble_ghost_faces_once, nullptr, on_face);
    else
      mesh_loop(sheet.dof_handler().active_cell_iterators(), on_cell, copy, Scratch(sheet), Blocks(),
                assemble_own_cells);
    K.compress(dealii::VectorOperation::add);
  }

  Multigrid::MatrixFactory matrix_factory() const
  {
    return [this](const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Matrix &K)
    { make_matrix(sheet, constraints, K); };
  }
  Multigrid::Assembler assembler() const
  {
    return [this](const Sheet &sheet, const Sheet::Vector &, const AffineConstraints<double> &constraints,
                  Sheet::Matrix &K) { assemble(sheet, constraints, K); };
  }

private:
  double square_; // squared internal length
};

/// Creates sheets of the same law and degree on coarser meshes.
inline Multigrid::SheetFactory same_sheets(const latcon::continuum::Material &law, const unsigned int degree)
{
  return [&law, degree](const Mesh &mesh) { return std::make_unique<Sheet>(mesh, law, degree); };
}

inline latcon::continuum::DirichletBoundaries all_held()
{
  return {{latcon::continuum::edge::left, {}},
          {latcon::continuum::edge::right, {}},
          {latcon::continuum::edge::bottom, {}},
          {latcon::continuum::edge::top, {}}};
}

/// Refines `times` times around `tip`, each time within half of the previous radius [m].
inline void refine_towards(Mesh &mesh, const Point<2> &tip, const unsigned int times, double radius)
{
  for (unsigned int n = 0; n < times; ++n, radius *= 0.5)
  {
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center().distance(tip) < radius)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
}

/// Returns the nodal forces of a body force with different components, zero at constrained unknowns.
inline void body_force(const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Vector &b)
{
  b = 0.;
  dealii::FEValues<2> values(sheet.mapping(), sheet.element(), dealii::QGauss<2>(sheet.degree() + 1),
                             dealii::update_values | dealii::update_JxW_values);
  const unsigned int n = sheet.element().n_dofs_per_cell();
  dealii::Vector<double> cell_b(n);
  std::vector<dealii::types::global_dof_index> dofs(n);
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      cell_b = 0.;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
          cell_b(a) += (sheet.element().system_to_component_index(a).first == 0 ? 1. : -0.6) *
                       values.shape_value(a, q) * values.JxW(q);
      cell->get_dof_indices(dofs);
      constraints.distribute_local_to_global(cell_b, dofs, b);
    }
  b.compress(dealii::VectorOperation::add);
}

/// Solves by conjugate gradients preconditioned by `multigrid`, starting from zero; returns the number of iterations.
inline unsigned int solve(const Multigrid &multigrid, const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b,
                          const double tolerance = 1e-8)
{
  Multigrid::Vector from;
  Multigrid::Vector to;
  multigrid.initialize(from);
  multigrid.initialize(to);
  Multigrid::copy(b, from);
  dealii::SolverControl control(200, tolerance * from.l2_norm());
  dealii::SolverCG<Multigrid::Vector> conjugate_gradients(control);
  conjugate_gradients.solve(K, to, from, multigrid);
  Multigrid::copy(to, x);
  return control.last_step();
}
} // namespace multigrid_cases
