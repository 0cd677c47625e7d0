#pragma once

// Tangents and meshes for tests of multigrid.

#include "continuum/multigrid.h"
#include "sheets.h"

#include <deal.II/base/function.h>
#include <deal.II/lac/solver_cg.h>

namespace multigrid_cases
{
using namespace sheets;
using dealii::AffineConstraints;
using latcon::continuum::Multigrid;
using latcon::continuum::Sheet;
using latcon::continuum::SinglePrecisionMatrix;

/// Assembles the tangent of a sheet at rest, whatever its state.
inline const auto assemble_at_rest = [](const Sheet &sheet, const Sheet::Vector &, auto &K)
{ sheet.tangent(sheet.make_ghosted(), sheet.homogeneous_constraints(), K); };

/// Prescribes no displacement on all edges, and a body force with different components.
inline latcon::continuum::BoundaryConditions all_held()
{
  latcon::continuum::BoundaryConditions conditions = on_all_edges(affine(matrix(1., 0., 0., 1.)));
  conditions.body_force = {std::make_shared<dealii::Functions::ConstantFunction<2>>(std::vector<double>{1., -0.6}), 0.};
  return conditions;
}

/// Prescribes no displacement across the left edge.
inline latcon::continuum::BoundaryConditions left_held_across()
{
  return {{latcon::continuum::edge::left, affine(matrix(1., 0., 0., 1.)), std::vector<bool>{true, false}}};
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

/// Returns the nodal forces of the body force of all_held(), zero at constrained unknowns.
inline Sheet::Vector body_force(const Sheet &sheet)
{
  Sheet::Vector b = sheet.loads();
  sheet.homogeneous_constraints().set_zero(b);
  return b;
}

/// Solves by conjugate gradients preconditioned by `multigrid`, starting from zero; returns the number of iterations.
inline unsigned int solve(const Multigrid &multigrid, const SinglePrecisionMatrix &K, Sheet::Vector &x,
                          const Sheet::Vector &b, const double tolerance = 1e-8)
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

/// Tangent at rest of a held sheet whose gradient law has this internal length [m], with its multigrid.
struct HeldSheet
{
  HeldSheet(const double internal_length, const unsigned int degree, const latcon::continuum::Rectangle &shape,
            const unsigned int times, const dealii::types::global_dof_index coarsest_size,
            const MPI_Comm communicator = MPI_COMM_SELF)
    : gradient(5e5, internal_length), mesh(communicator)
  {
    latcon::continuum::make_rectangle(mesh, shape);
    refine_towards(mesh, Point<2>(0.4 * length, 0.003), times, length / 3.);
    sheet = std::make_unique<Sheet>(mesh, latcon::continuum::Constitution(law, gradient), degree, all_held());
    multigrid = std::make_unique<Multigrid>(*sheet, coarsest_size);
    K.reinit(*sheet, sheet->homogeneous_constraints());
    assemble_at_rest(*sheet, {}, K);
    K.make_symmetric();
    multigrid->set_finest(K);
    multigrid->update(sheet->make_ghosted(), assemble_at_rest);
  }

  latcon::continuum::MooneyRivlin law = rubber_sheet();
  latcon::continuum::IsotropicGradient gradient;
  Mesh mesh;
  std::unique_ptr<Sheet> sheet;
  SinglePrecisionMatrix K;
  std::unique_ptr<Multigrid> multigrid;
};
} // namespace multigrid_cases
