#include "continuum/linear_solver.h"

#include "continuum/errors.h"

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>

#include <Amesos.h>
#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>

#include <cmath>

using namespace dealii;

namespace continuum
{
/// The six fields a + B X of a plane sheet at the own degrees of freedom, one after the other. Rotations of the
/// deformed sheet are among them wherever the deformation is homogeneous.
struct LinearSolver::NearNullSpace
{
  static constexpr unsigned int n_fields = 6;
  std::vector<double> values;
};

namespace
{
std::string direct_solver_name()
{
  static const std::string name = Amesos().Query("Amesos_Mumps") ? "Amesos_Mumps" : "Amesos_Klu";
  return name;
}
} // namespace

LinearSolver::LinearSolver(const Sheet &sheet, const LinearSettings &settings)
  : settings_(settings), is_direct_(sheet.dof_handler().n_dofs() <= settings.direct_limit),
    communicator_(sheet.communicator())
{
  if (!(settings.relative_tolerance > 0. && settings.relative_tolerance < 1.))
    throw InvalidInput("the relative tolerance of the linear solver must lie between 0 and 1");
  if (is_direct_)
    return;

  near_null_space_ = std::make_unique<NearNullSpace>();
  const IndexSet &owned = sheet.owned();
  const std::size_t n = owned.n_elements();
  std::vector<double> &values = near_null_space_->values;
  values.assign(NearNullSpace::n_fields * n, 0.);

  // Fields of order one, whatever the unit of length, so that none is lost in orthogonalisation.
  double own_size = 0.;
  for (const auto &cell : sheet.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int v : cell->vertex_indices())
        own_size = std::max(own_size, cell->vertex(v).norm());
  const double size = Utilities::MPI::max(own_size, communicator_);

  const auto &element = sheet.element();
  std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
    {
      cell->get_dof_indices(dofs);
      for (unsigned int a = 0; a < dofs.size(); ++a)
        if (owned.is_element(dofs[a]))
        {
          const Point<2> X = sheet.mapping().transform_unit_to_real_cell(cell, element.unit_support_point(a));
          const unsigned int i = element.system_to_component_index(a).first;
          const std::size_t at = owned.index_within_set(dofs[a]);
          values[i * n + at] = 1.;
          values[(2 + i) * n + at] = X[0] / size;
          values[(4 + i) * n + at] = X[1] / size;
        }
    }
}

LinearSolver::~LinearSolver() = default;

unsigned int LinearSolver::solve(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b) const
{
  // deal.II's and Trilinos' exceptions here follow from collective results, so all ranks take the same branch.
  unsigned int iterations = 0;
  x = 0.;
  if (b.l2_norm() == 0.)
    return 0;
  try
  {
    if (is_direct_)
    {
      SolverControl control(1, 0.);
      TrilinosWrappers::SolverDirect direct(
        control, TrilinosWrappers::SolverDirect::AdditionalData(false, direct_solver_name()));
      direct.solve(K, x, b);
    }
    else
    {
      TrilinosWrappers::PreconditionAMG::AdditionalData data(true);
      data.higher_order_elements = false;
      data.smoother_sweeps = 2;
      Teuchos::ParameterList parameters;
      std::unique_ptr<Epetra_MultiVector> unused;
      data.set_parameters(parameters, unused, K);
      parameters.set("null space: type", "pre-computed");
      parameters.set("null space: dimension", static_cast<int>(NearNullSpace::n_fields));
      parameters.set("null space: vectors", near_null_space_->values.data());
      TrilinosWrappers::PreconditionAMG multigrid;
      multigrid.initialize(K, parameters);

      SolverControl control(settings_.max_iterations, settings_.relative_tolerance * b.l2_norm());
      SolverCG<Sheet::Vector> conjugate_gradients(control);
      conjugate_gradients.solve(K, x, b, multigrid);
      iterations = control.last_step();
    }
  }
  catch (const SolverControl::NoConvergence &failure)
  {
    throw LinearSolverFailed("conjugate gradients stopped after " + std::to_string(failure.last_step) + " iterations");
  }
  catch (const ExceptionBase &failure)
  {
    throw LinearSolverFailed(std::string("the linear solver failed: ") + failure.what());
  }
  if (!std::isfinite(x.l2_norm()))
    throw LinearSolverFailed("the linear solver gave an answer that is not finite");
  return iterations;
}
} // namespace continuum
