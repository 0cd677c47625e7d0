#include "continuum/linear_solver.h"

#include "continuum/errors.h"

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_gmres.h>

#include <algorithm>
#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
LinearSolver::LinearSolver(const Sheet &sheet, const LinearSettings &settings, const Symmetry symmetry)
  : sheet_(sheet), settings_(settings),
    is_direct_(sheet.dof_handler().n_dofs() <= settings.direct_limit || !sheet.conditions().periodic.empty()),
    symmetry_(symmetry), multigrid_state_(sheet.make_ghosted())
{
  if (!(settings.relative_tolerance > 0. && settings.relative_tolerance < 1.))
    throw InvalidInput("the relative tolerance of the linear solver must be in (0, 1)");
}

void LinearSolver::update(const Sheet::Vector &u, const Assembler &assemble, const Assembler &assemble_coarser)
{
  is_fresh_ = false;
  if (is_direct_)
  {
    if (!matrix_)
    {
      matrix_ = std::make_unique<Sheet::Matrix>();
      sheet_.make_matrix(sheet_.homogeneous_constraints(), *matrix_);
      direct_ = std::make_unique<DirectSolver>();
    }
    assemble(sheet_, u, *matrix_);
    is_stale_ = false;
    return;
  }
  if (!single_matrix_)
  {
    single_matrix_ = std::make_unique<SinglePrecisionMatrix>();
    single_matrix_->reinit(sheet_, sheet_.homogeneous_constraints());
  }
  assemble(sheet_, u, *single_matrix_);
  if (symmetry_ == Symmetry::symmetric)
    single_matrix_->make_symmetric();
  state_.reinit(u);
  state_ = u;
  assemble_coarser_ = assemble_coarser;
  if (is_stale_)
    set_up();
  else
    multigrid_->set_finest(*single_matrix_);
}

void LinearSolver::set_up()
{
  if (!multigrid_)
    multigrid_ = std::make_unique<Multigrid>(sheet_, settings_.coarsest_size);
  is_stale_ = true; // also if the update throws
  multigrid_->set_finest(*single_matrix_);
  multigrid_->update(state_, assemble_coarser_);
  multigrid_state_ = state_;
  is_stale_ = false;
  is_fresh_ = true;
  baseline_iterations_ = 0.;
  ++n_set_ups_;
}

void LinearSolver::restore(const Assembler &assemble, const Assembler &assemble_coarser)
{
  const double baseline_iterations = baseline_iterations_;
  const unsigned int n_set_ups = n_set_ups_;
  invalidate();
  update(multigrid_state_, assemble, assemble_coarser);
  baseline_iterations_ = baseline_iterations;
  n_set_ups_ = n_set_ups;
}

double LinearSolver::diag_element(const types::global_dof_index i) const
{
  return matrix_ ? matrix_->diag_element(i) : single_matrix_ ? single_matrix_->diag_element(i) : 0.;
}

void LinearSolver::release()
{
  matrix_.reset();
  direct_.reset();
  multigrid_.reset();
  single_matrix_.reset();
  invalidate();
}

unsigned int LinearSolver::solve(Sheet::Vector &x, const Sheet::Vector &b, const double relative_tolerance)
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
        direct_->factorise(*matrix_);
      is_fresh_ = true;
      direct_->solve(x, b);
    }
    else
      iterations = iterate(x, b, std::max(relative_tolerance, settings_.relative_tolerance));
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

unsigned int LinearSolver::iterate(Sheet::Vector &x, const Sheet::Vector &b, const double relative_tolerance)
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
      SolverCG<Multigrid::Vector>(control).solve(*single_matrix_, to, from, *multigrid_);
    else
    {
      // Right preconditioning, so that the iteration stops on the residual of K. An up-to-date multigrid needs fewer
      // iterations than the 50 vectors before a GMRES restart.
      const SolverGMRES<Multigrid::Vector>::AdditionalData data(50, true);
      SolverGMRES<Multigrid::Vector>(control, data).solve(*single_matrix_, to, from, *multigrid_);
    }
  }
  catch (const SolverControl::NoConvergence &)
  {
    if (is_fresh_)
      throw;
    set_up();
    return control.last_step() + iterate(x, b, relative_tolerance);
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
