#include "continuum/linear_solver.h"

#include "continuum/errors.h"

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_solver.h>

#include <Amesos.h>

#include <cmath>

using namespace dealii;

namespace continuum
{
namespace
{
std::string direct_solver_name()
{
  static const std::string name = Amesos().Query("Amesos_Mumps") ? "Amesos_Mumps" : "Amesos_Klu";
  return name;
}
} // namespace

LinearSolver::LinearSolver(const Sheet &sheet, HeldBoundaries held, const LinearSettings &settings)
  : sheet_(sheet), held_(std::move(held)), settings_(settings),
    is_direct_(sheet.dof_handler().n_dofs() <= settings.direct_limit || !sheet.conditions().periodic.empty())
{
  if (!(settings.relative_tolerance > 0. && settings.relative_tolerance < 1.))
    throw InvalidInput("the relative tolerance of the linear solver must lie between 0 and 1");
}

void LinearSolver::update(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble)
{
  if (is_direct_)
    return;
  if (!multigrid_)
    multigrid_ = std::make_unique<Multigrid>(
      sheet_, [this](const Sheet::Mesh &mesh) { return sheet_.on(mesh); },
      [](const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Matrix &matrix)
      { sheet.make_matrix(constraints, matrix); },
      held_, settings_.multigrid);
  multigrid_->update(u, K, assemble);
}

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
      Multigrid::Vector from;
      Multigrid::Vector to;
      multigrid_->initialize(from);
      multigrid_->initialize(to);
      Multigrid::copy(b, from);
      SolverControl control(settings_.max_iterations, settings_.relative_tolerance * from.l2_norm());
      SolverCG<Multigrid::Vector> conjugate_gradients(control);
      conjugate_gradients.solve(K, to, from, *multigrid_);
      Multigrid::copy(to, x);
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
