#include "continuum/linear_solver.h"

#include "continuum/errors.h"

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
LinearSolver::LinearSolver(const Sheet &sheet, DirichletBoundaries held, const LinearSettings &settings,
                           const Symmetry symmetry)
  : sheet_(sheet), held_(std::move(held)), settings_(settings),
    is_direct_(sheet.dof_handler().n_dofs() <= settings.direct_limit || !sheet.conditions().periodic.empty()),
    symmetry_(symmetry)
{
  if (!(settings.relative_tolerance > 0. && settings.relative_tolerance < 1.))
    throw InvalidInput("the relative tolerance of the linear solver must be in (0, 1)");
  if (!(settings.rebuild_ratio >= 0. && std::isfinite(settings.rebuild_ratio)))
    throw InvalidInput("rebuild_ratio of the linear solver must be finite and >= 0");
}

void LinearSolver::update(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble)
{
  is_fresh_ = false;
  if (is_direct_)
    return;
  state_.reinit(u);
  state_ = u;
  assemble_ = assemble;
  if (is_stale_)
    set_up(K);
}

void LinearSolver::set_up(const Sheet::Matrix &K)
{
  if (!multigrid_)
    multigrid_ = std::make_unique<Multigrid>(
      sheet_, [this](const Sheet::Mesh &mesh) { return sheet_.clone_on(mesh); },
      [](const Sheet &sheet, const AffineConstraints<double> &constraints, Sheet::Matrix &matrix)
      { sheet.make_matrix(constraints, matrix); },
      held_, settings_.multigrid);
  is_stale_ = true; // also if the update throws
  if (symmetry_ == Symmetry::symmetric)
    multigrid_->update(state_, K, assemble_);
  else
  {
    Sheet::Matrix symmetric;
    symmetric.reinit(K); // with the sparsity of K
    assemble_(sheet_, state_, multigrid_->constraints(), symmetric);
    multigrid_->update(state_, symmetric, assemble_);
  }
  is_stale_ = false;
  is_fresh_ = true;
  baseline_iterations_ = 0.;
  ++n_set_ups_;
}

void LinearSolver::restore(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble)
{
  const double baseline_iterations = baseline_iterations_;
  const unsigned int n_set_ups = n_set_ups_;
  invalidate();
  update(u, K, assemble);
  baseline_iterations_ = baseline_iterations;
  n_set_ups_ = n_set_ups;
}

unsigned int LinearSolver::solve(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b,
                                 const double relative_tolerance)
{
  // The exceptions of deal.II and Trilinos depend on collective results, so all ranks take the same branch.
  unsigned int iterations = 0;
  x = 0.;
  if (b.l2_norm() == 0.)
    return 0;
  try
  {
    if (is_direct_)
    {
      if (!is_fresh_)
        direct_.factorise(K);
      is_fresh_ = true;
      direct_.solve(x, b);
    }
    else
      iterations = iterate(K, x, b, std::max(relative_tolerance, settings_.relative_tolerance));
  }
  catch (const SolverControl::NoConvergence &failure)
  {
    throw LinearSolverFailed(std::string(symmetry_ == Symmetry::symmetric ? "conjugate gradients" : "GMRES") +
                             " stopped after " + std::to_string(failure.last_step) + " iterations");
  }
  catch (const dealii::ExceptionBase &failure)
  {
    throw LinearSolverFailed(std::string("the linear solver failed: ") + failure.what());
  }
  if (!std::isfinite(x.l2_norm()))
    throw LinearSolverFailed("the solution of the linear solver is not finite");
  return iterations;
}

unsigned int LinearSolver::iterate(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b,
                                   const double relative_tolerance)
{
  Multigrid::Vector from;
  Multigrid::Vector to;
  multigrid_->initialize(from);
  multigrid_->initialize(to);
  Multigrid::copy(b, from);
  SolverControl control(settings_.max_iterations, relative_tolerance * from.l2_norm());
  try
  {
    if (symmetry_ == Symmetry::symmetric)
      SolverCG<Multigrid::Vector>(control).solve(K, to, from, *multigrid_);
    else
    {
      // Right preconditioning, so that the iteration stops on the residual of K. An up-to-date multigrid needs fewer
      // iterations than the 50 vectors before a GMRES restart.
      const SolverGMRES<Multigrid::Vector>::AdditionalData data(50, true);
      SolverGMRES<Multigrid::Vector>(control, data).solve(K, to, from, *multigrid_);
    }
  }
  catch (const SolverControl::NoConvergence &)
  {
    if (is_fresh_)
      throw;
    set_up(K);
    return control.last_step() + iterate(K, x, b, relative_tolerance);
  }
  Multigrid::copy(to, x);
  // Convergence is slow at first, which costs as much as these additional digits for any tolerance.
  constexpr double initial_digits = 3.;
  const double effort = control.last_step() / (initial_digits - std::log10(relative_tolerance));
  if (is_fresh_)
    baseline_iterations_ = std::max(baseline_iterations_, effort);
  is_stale_ = effort > settings_.rebuild_ratio * baseline_iterations_;
  return control.last_step();
}
} // namespace latcon::continuum
