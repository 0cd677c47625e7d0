#include "continuum/dynamic_solver.h"

#include "support/text_wrap.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/grid/filtered_iterator.h>

#include <algorithm>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
NewmarkParameters NewmarkParameters::generalised_alpha(const double rho_inf)
{
  require(rho_inf >= 0. && rho_inf <= 1., "the high-frequency amplification rho_inf must be in [0, 1]");
  const double alpha_m = (2. * rho_inf - 1.) / (rho_inf + 1.);
  const double alpha_f = rho_inf / (rho_inf + 1.);
  const double gamma = 0.5 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * (0.5 + gamma) * (0.5 + gamma), gamma};
}

DynamicSolver::DynamicSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
                             const Inertia &inertia, const DynamicSettings &settings, const Viscosity *viscosity,
                             const FibreMemory *memory)
  : sheet_(mesh, constitution, settings.degree, std::move(conditions)), inertia_(inertia), settings_(settings),
    duration_(settings.time_step), rate_forces_(sheet_, viscosity, memory)
{
  require(inertia_.density > 0. && std::isfinite(inertia_.density), "the density must be positive and finite");
  require(inertia_.length >= 0. && std::isfinite(inertia_.length), "the micro-inertia length must be finite and >= 0");
  require(settings_.time_step > 0. && std::isfinite(settings_.time_step), "the time step must be positive and finite");
  require(settings_.relative_tolerance > 0. && settings_.relative_tolerance < 1.,
          "the relative tolerance of the residual must be in (0, 1)");
  const NewmarkParameters &rule = settings_.rule;
  constexpr double rounding = 1e-12;
  require(rule.alpha_m <= rule.alpha_f + rounding && rule.alpha_f <= 0.5 + rounding && rule.alpha_f >= 0. &&
            rule.beta >= 0.25 + 0.5 * (rule.alpha_f - rule.alpha_m) - rounding && std::isfinite(rule.beta),
          "a time integrator is stable only with alpha_m <= alpha_f <= 1/2 and beta >= 1/4 + (alpha_f - alpha_m)/2");
  require(std::abs(rule.gamma - (0.5 - rule.alpha_m + rule.alpha_f)) <= rounding,
          "a time integrator is of second order only with gamma = 1/2 - alpha_m + alpha_f");

  apply_conditions();
  sheet_.make_matrix(sheet_.conformity_constraints(), full_mass_, /* is_mass */ true);
  sheet_.add_mass(inertia_.density, inertia_.length, sheet_.conformity_constraints(), full_mass_);
  if (inertia_.length > 0.)
  {
    sheet_.make_matrix(sheet_.conformity_constraints(), plain_mass_, /* is_mass */ true);
    sheet_.add_mass(inertia_.density, 0., sheet_.conformity_constraints(), plain_mass_);
  }

  state_.displacement = state_.velocity = state_.acceleration = sheet_.make_ghosted();
  elastic_diagonal_ = sheet_.make_owned();
  effective_diagonal_ = sheet_.make_owned();
  release_forces_ = sheet_.make_owned();
}

// Sets up everything that depends on the boundaries with prescribed displacement.
void DynamicSolver::apply_conditions()
{
  lift_ = sheet_.lift();
  loads_ = sheet_.loads();
  // Viscosity at finite strain makes the matrix unsymmetric.
  linear_solver_ = std::make_unique<LinearSolver>(
    sheet_, settings_.linear, rate_forces_.is_present() ? Symmetry::unsymmetric : Symmetry::symmetric);
}

void DynamicSolver::check_start(const Vector &u, const Vector &v) const
{
  require(u.size() == lift_.size() && v.size() == lift_.size(),
          "an initial nodal vector must have the size of the sheet's vectors");
  require(std::isfinite(u.l2_norm()) && std::isfinite(v.l2_norm()),
          "the initial displacement and velocity must be finite");
  double extent = 0.;
  for (const auto &cell : sheet_.mesh().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
    for (const unsigned int vertex : cell->vertex_indices())
      extent = std::max(extent, cell->vertex(vertex).norm());
  extent = dealii::Utilities::MPI::max(extent, sheet_.communicator());
  double off = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (sheet_.is_prescribed(i))
      off = std::max(off, std::abs(u(i) - lift_(i)));
  require(dealii::Utilities::MPI::max(off, sheet_.communicator()) <= 1e-8 * extent,
          "the initial state, its base and displacement, differs from what is prescribed on an edge");
}

void DynamicSolver::start(const Vector &displacement, const Vector &velocity, const std::vector<Vector> &relaxed)
{
  check_start(displacement, velocity);
  Vector u = sheet_.without_ghosts(displacement);
  Vector v = sheet_.without_ghosts(velocity);
  for (const types::global_dof_index i : sheet_.owned())
    if (sheet_.is_prescribed(i))
      u(i) = lift_(i);
  u.compress(VectorOperation::insert);
  sheet_.homogeneous_constraints().distribute(v);

  // Solve M a = L - internal and viscous forces; prescribed unknowns stand still.
  const Vector u_ghosted = sheet_.with_ghosts(u);
  const Vector v_ghosted = sheet_.with_ghosts(v);
  Vector forces = sheet_.make_owned();
  Vector magnitude = sheet_.make_owned();
  sheet_.residual(u_ghosted, forces, magnitude);
  std::vector<Vector> relaxed_ghosted;
  for (const Vector &at_rest : relaxed)
    relaxed_ghosted.push_back(sheet_.with_ghosts(at_rest));
  rate_forces_.start(u_ghosted, relaxed_ghosted);
  rate_forces_.add_forces(0., u_ghosted, v_ghosted, forces, nullptr);
  forces.sadd(-1., 1., loads_);
  sheet_.homogeneous_constraints().set_zero(forces);
  Vector a = sheet_.make_owned();
  linear_solver_->invalidate();
  const auto assemble_mass = [this](const Sheet &level, const Vector &, auto &M)
  {
    M = 0.;
    level.add_mass(inertia_.density, inertia_.length, level.homogeneous_constraints(), M);
  };
  linear_solver_->update(u_ghosted, assemble_mass, assemble_mass);
  linear_solver_->solve(a, forces);
  linear_solver_->invalidate();
  sheet_.homogeneous_constraints().distribute(a);

  // Diagonals for the round-off of the residual, needed before the first Newton step.
  linear_solver_->update(u_ghosted, assembler(v_ghosted), level_assembler());

  state_ = {0., u_ghosted, v_ghosted, sheet_.with_ghosts(a), {}, {}};
  n_steps_ = 0;
  n_divided_steps_ = 0;
  report_ = SolverReport();
  rate_forces_.advanced(0., u_ghosted, state_.branch_energies);
  update_energies(state_, v);
  initial_energy_ = state_.ledger.stored + state_.ledger.kinetic;
  has_started_ = true;
  has_released_ = false;
}

// Returns the fraction of the release forces that acts at `time` [-].
double DynamicSolver::release_share(const double time) const
{
  const double passed = time - release_time_;
  return has_released_ && passed < release_duration_ ? 1. - std::max(passed, 0.) / release_duration_ : 0.;
}

// Returns the reactions at constrained nodes, and the residual of the equation of motion at free nodes [N/m].
DynamicSolver::Vector DynamicSolver::reactions() const
{
  Vector forces = sheet_.make_owned();
  Vector inertial = sheet_.make_owned();
  Vector magnitude = sheet_.make_owned();
  multiply_by_mass(full_mass_, sheet_.without_ghosts(state_.acceleration), inertial);
  sheet_.residual(state_.displacement, forces, magnitude);
  rate_forces_.add_forces(0., state_.displacement, state_.velocity, forces, nullptr);
  forces += inertial;
  forces.add(-1., loads_, -release_share(state_.time), release_forces_);
  return forces;
}

void DynamicSolver::release(const double duration)
{
  require(has_started_, "release() needs a state: call start() first");
  require(duration >= 0. && std::isfinite(duration), "the duration of a release must be finite and >= 0");
  require(release_share(state_.time) <= 1e-9,
          "release() while the reactions of an earlier release still act is not supported");
  require(linear_solver_->is_direct(), "release() is supported with the direct solver only");
  require(!rate_forces_.has_gradient_memory(), // whose history depends on the conditions of faces
          "release() with the gradient part of Maxwell branches is not supported");
  const Vector forces = reactions();
  AffineConstraints<double> before;
  before.copy_from(sheet_.homogeneous_constraints());
  sheet_.apply_conditions();
  apply_conditions();
  const AffineConstraints<double> &after = sheet_.homogeneous_constraints();
  bool holds_more = false;
  release_forces_ = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!sheet_.conformity_constraints().is_constrained(i))
    {
      holds_more = holds_more || (after.is_constrained(i) && !before.is_constrained(i));
      if (before.is_constrained(i) && !after.is_constrained(i))
        release_forces_(i) = forces(i);
    }
  release_forces_.compress(VectorOperation::insert);
  require(dealii::Utilities::MPI::max(holds_more ? 1 : 0, sheet_.communicator()) == 0,
          "release() cannot prescribe the displacement of a free node");
  has_released_ = true;
  release_time_ = state_.time;
  release_duration_ = duration;
}

// Computes M x without the rows of constrained unknowns, whose entries AffineConstraints adds to keep the matrix
// regular.
void DynamicSolver::multiply_by_mass(const Sheet::Matrix &M, const Vector &x, Vector &product) const
{
  M.vmult(product, x);
  sheet_.conformity_constraints().set_zero(product);
}

void DynamicSolver::step()
{
  require(has_started_, "step() needs a state: call start() first");
  const double target = (n_steps_ + 1) * settings_.time_step;
  const auto restore = [this, state = state_, history = rate_forces_.history()]
  {
    state_ = state;
    rate_forces_.set_history(history);
    linear_solver_->invalidate(); // multigrid may belong to a distant state
  };
  report_ = SolverReport();
  std::string failure;
  try
  {
    failure = advance_in_parts(settings_.time_step, target, settings_.max_step_halvings);
  }
  catch (...)
  {
    restore();
    duration_ = settings_.time_step;
    throw;
  }
  if (!failure.empty())
    restore();
  else
    ++n_steps_;
  if (duration_ != settings_.time_step)
  {
    duration_ = settings_.time_step;
    linear_solver_->invalidate(); // multigrid belongs to a shorter step
    n_divided_steps_ += failure.empty() ? 1 : 0;
  }
  if (!failure.empty())
    throw SolverFailed(support::formatted("the time step from %.17g s failed: ", state_.time) + failure, report_);
}

std::vector<Tensor<2, 2>> DynamicSolver::rate_stresses() const
{
  std::vector<Tensor<2, 2>> stresses;
  if (!rate_forces_.is_present())
    return stresses;
  stresses.resize(sheet_.mesh().n_locally_owned_active_cells() * QGauss<2>(sheet_.degree() + 1).size());
  rate_forces_.add_stresses(state_.displacement, state_.velocity, stresses);
  return stresses;
}
} // namespace latcon::continuum
