#include "continuum/dynamic_solver.h"

#include "continuum/collective.h"
#include "continuum/dynamic_step.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
NewmarkParameters NewmarkParameters::generalised_alpha(const double rho_inf)
{
  if (!(rho_inf >= 0. && rho_inf <= 1.))
    throw InvalidInput("the high-frequency amplification rho_inf must be in [0, 1]");
  const double alpha_m = (2. * rho_inf - 1.) / (rho_inf + 1.);
  const double alpha_f = rho_inf / (rho_inf + 1.);
  const double gamma = 0.5 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * (0.5 + gamma) * (0.5 + gamma), gamma};
}

DynamicSolver::DynamicSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
                             const Inertia &inertia, const DynamicSettings &settings, const Viscosity *viscosity,
                             LoadFactor load_factor, const FibreMemory *memory)
  : sheet_(mesh, constitution, settings.degree, std::move(conditions)), inertia_(inertia), settings_(settings),
    duration_(settings.time_step), rate_forces_(sheet_, viscosity, memory), given_load_factor_(std::move(load_factor))
{
  check_input();
  set_up();
}

void DynamicSolver::check_input() const
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
}

// Sets up everything that depends on the mesh.
void DynamicSolver::set_up()
{
  apply_conditions();
  sheet_.make_matrix(sheet_.conformity_constraints(), full_mass_, /* is_mass */ true);
  sheet_.add_mass(inertia_.density, inertia_.length, sheet_.conformity_constraints(), full_mass_);
  if (inertia_.length > 0.)
  {
    sheet_.make_matrix(sheet_.conformity_constraints(), plain_mass_, /* is_mass */ true);
    sheet_.add_mass(inertia_.density, 0., sheet_.conformity_constraints(), plain_mass_);
  }

  double smallest = std::numeric_limits<double>::infinity();
  for (const auto &cell : sheet_.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      smallest = std::min(smallest, cell->minimum_vertex_distance());
  smallest_cell_ = dealii::Utilities::MPI::min(smallest, sheet_.communicator());

  displacement_ = sheet_.make_ghosted();
  velocity_ = sheet_.make_ghosted();
  acceleration_ = sheet_.make_ghosted();
  multigrid_displacement_ = sheet_.make_ghosted();
  elastic_diagonal_ = sheet_.make_owned();
  effective_diagonal_ = sheet_.make_owned();
  release_forces_ = sheet_.make_owned();
}

// Sets up everything that depends on the boundaries with prescribed displacement.
void DynamicSolver::apply_conditions()
{
  full_lift_ = sheet_.lift();
  const DirichletBoundaries held = dirichlet_boundaries(sheet_.conditions());
  homogeneous_.copy_from(homogeneous_constraints(sheet_, held));

  loads_ = sheet_.loads();
  // Viscosity at finite strain makes the matrix unsymmetric.
  linear_solver_ =
    std::make_unique<LinearSolver>(sheet_, homogeneous_, held, settings_.linear,
                                   rate_forces_.is_present() ? Symmetry::unsymmetric : Symmetry::symmetric);
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
  Vector a = sheet_.make_owned();
  a = acceleration_;
  multiply_by_mass(full_mass_, a, inertial);
  sheet_.residual(displacement_, forces, magnitude, load_factor_);
  rate_forces_.add_forces(0., displacement_, velocity_, load(), forces, nullptr);
  forces += inertial;
  forces.add(-load_factor_, loads_, -release_share(time_), release_forces_);
  return forces;
}

void DynamicSolver::release(const double duration)
{
  if (!has_started_)
    throw InvalidInput("release() needs a state: call start() first");
  if (!(duration >= 0.) || !std::isfinite(duration))
    throw InvalidInput("the duration of a release must be finite and >= 0");
  if (release_share(time_) > 1e-9)
    throw InvalidInput("release() while the reactions of an earlier release still act is not supported");
  if (!linear_solver_->is_direct())
    throw InvalidInput("release() is supported with the direct solver only");
  if (rate_forces_.has_gradient_memory()) // whose history depends on the conditions of faces
    throw InvalidInput("release() with the gradient part of Maxwell branches is not supported");
  const Vector forces = reactions();
  AffineConstraints<double> before;
  before.copy_from(homogeneous_);
  apply_conditions();
  bool holds_more = false;
  release_forces_ = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!sheet_.conformity_constraints().is_constrained(i))
    {
      holds_more = holds_more || (homogeneous_.is_constrained(i) && !before.is_constrained(i));
      if (before.is_constrained(i) && !homogeneous_.is_constrained(i))
        release_forces_(i) = forces(i);
    }
  release_forces_.compress(VectorOperation::insert);
  if (dealii::Utilities::MPI::max(holds_more ? 1 : 0, sheet_.communicator()) == 1)
    throw InvalidInput("release() cannot prescribe the displacement of a free node");
  has_released_ = true;
  release_time_ = time_;
  release_duration_ = duration;
}

double DynamicSolver::load_factor_at(const double time) const
{
  double factor = 1.;
  run_collectively(sheet_.communicator(),
                   [&]
                   {
                     if (given_load_factor_)
                       factor = given_load_factor_(time);
                     if (!std::isfinite(factor))
                       throw InvalidInput("the load factor at time " + std::to_string(time) + " s is not finite");
                   });
  return factor;
}

// Returns the rates of the load factor at the end `time` of a step of `duration`, by central differences over it; the
// second one at the time at which the time integrator has its accelerations, see acceleration().
DynamicSolver::LoadFactorRates DynamicSolver::load_factor_rates(const double time, const double duration) const
{
  if (!given_load_factor_)
    return {};
  const double of_acceleration = time + (settings_.rule.alpha_m - settings_.rule.alpha_f) * duration;
  return {(load_factor_at(time + duration) - load_factor_at(time - duration)) / (2. * duration),
          (load_factor_at(of_acceleration + duration) - 2. * load_factor_at(of_acceleration) +
           load_factor_at(of_acceleration - duration)) /
            (duration * duration)};
}

// Returns it and its first rate at the present time; a load factor need not be defined before the start.
GradientLoad DynamicSolver::load() const
{
  if (!given_load_factor_)
    return {load_factor_};
  const double dt = settings_.time_step;
  if (n_steps_ > 0)
    return {load_factor_, load_factor_rates(time_, dt).first};
  return {load_factor_,
          (-3. * load_factor_ + 4. * load_factor_at(time_ + dt) - load_factor_at(time_ + 2. * dt)) / (2. * dt)};
}

// Sets x to `factor` times the prescribed displacement where the displacement is prescribed.
void DynamicSolver::prescribe(Vector &x, const double factor) const
{
  for (const types::global_dof_index i : sheet_.owned())
    if (is_prescribed(i))
      x(i) = factor * full_lift_(i);
  x.compress(VectorOperation::insert);
  sheet_.conformity_constraints().distribute(x);
}

// Computes velocity and acceleration at the end of a step that leads to the displacement u.
void DynamicSolver::end_rates(const Step &step, const Vector &u, Vector &v, Vector &a) const
{
  a = step.last_acceleration(u);
  v = step.last_velocity(a);
  if (!given_load_factor_) // Newmark's formulas keep both at zero
    return;
  prescribe(v, step.last_rates.first);
  prescribe(a, step.last_rates.second);
}

DynamicSolver::Vector DynamicSolver::with_ghosts(const Vector &owned) const
{
  Vector x = sheet_.make_ghosted();
  x = owned;
  return x;
}

// Interpolates a field and applies the constraints at hanging nodes; those at periodic edges are not applied, because
// the field may be affine.
DynamicSolver::Vector DynamicSolver::interpolate(const VectorField &field) const
{
  Vector x = sheet_.make_owned();
  if (field)
  {
    const DeferredException guarded(
      [&]
      {
        if (field->n_components != 2)
          throw InvalidInput("an initial field must be a function with two components");
        sheet_.for_each_owned_dof([&](const auto dof, const unsigned int component, const Point<2> &X)
                                  { x(dof) = field->value(X, component); });
      });
    x.compress(VectorOperation::insert);
    guarded.rethrow_collectively(sheet_.communicator());
  }
  AffineConstraints<double> hanging(sheet_.relevant());
  DoFTools::make_hanging_node_constraints(sheet_.dof_handler(), hanging);
  hanging.close();
  hanging.distribute(x);
  return x;
}

// Computes M x without the rows of constrained unknowns, whose entries AffineConstraints adds to keep the matrix
// regular.
void DynamicSolver::multiply_by_mass(const Sheet::Matrix &M, const Vector &x, Vector &product) const
{
  M.vmult(product, x);
  for (const types::global_dof_index i : sheet_.owned())
    if (sheet_.conformity_constraints().is_constrained(i))
      product(i) = 0.;
  product.compress(VectorOperation::insert);
}

double DynamicSolver::norm_over_free(const Vector &x) const
{
  double sum = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!homogeneous_.is_constrained(i))
      sum += x(i) * x(i);
  return std::sqrt(dealii::Utilities::MPI::sum(sum, sheet_.communicator()));
}

void DynamicSolver::check_loaded() const
{
  if (!(std::abs(time_ - (start_time_ + n_steps_ * settings_.time_step)) <=
        4. * std::numeric_limits<double>::epsilon() * std::max(std::abs(start_time_), std::abs(time_))))
    throw InvalidInput("the stored time does not match the number of stored steps");
}

void DynamicSolver::step()
{
  if (!has_started_)
    throw InvalidInput("step() needs a state: call start() first");
  const double target = start_time_ + (n_steps_ + 1) * settings_.time_step;
  const auto restore = [this, time = time_, load_factor = load_factor_, u = displacement_, v = velocity_,
                        a = acceleration_, ledger = ledger_, history = rate_forces_.history(),
                        branch_energies = branch_energies_]
  {
    time_ = time;
    load_factor_ = load_factor;
    displacement_ = u;
    velocity_ = v;
    acceleration_ = a;
    ledger_ = ledger;
    rate_forces_.set_history(history);
    branch_energies_ = branch_energies;
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
  report_.load_factor = load_factor_;
  if (!failure.empty())
  {
    std::ostringstream message;
    message.precision(std::numeric_limits<double>::max_digits10);
    message << "the time step from " << time_ << " s failed: " << failure;
    throw SolverFailed(message.str(), report_);
  }
}

// Advances to `end`, dividing the step where necessary. Returns the reason of failure, empty on success.
std::string DynamicSolver::advance_in_parts(const double duration, const double end, const unsigned int halvings)
{
  const double middle = end - 0.5 * duration;
  std::string failure = advance(duration, end);
  if (failure.empty() || halvings == 0)
    return failure;
  failure = advance_in_parts(0.5 * duration, middle, halvings - 1);
  return failure.empty() ? advance_in_parts(0.5 * duration, end, halvings - 1) : failure;
}

// Advances to `end` in one step. Returns the reason of failure, empty on success; after a failure the state is
// unchanged.
std::string DynamicSolver::advance(const double duration, const double end)
{
  if (duration != duration_)
    linear_solver_->invalidate();
  duration_ = duration;
  Step step{settings_.rule,      duration,
            sheet_.make_owned(), sheet_.make_owned(),
            sheet_.make_owned(), load_factor_,
            load_factor_at(end), release_share(time_),
            release_share(end),  load_factor_rates(end, duration)};
  step.u = displacement_;
  step.v = velocity_;
  step.a = acceleration_;
  Vector u = sheet_.make_owned();
  Vector v;
  Vector a;
  EnergyLedger ledger;
  RateForces::History history;
  std::vector<BranchEnergy> branch_energies = branch_energies_;
  std::string failure = attempt(step, u);
  if (failure.empty())
    try
    {
      end_rates(step, u, v, a);
      history = rate_forces_.advanced(duration, with_ghosts(u), step.last_load_factor, branch_energies);
      ledger = ledger_after(step, u, v, branch_energies);
      if (!std::isfinite(ledger.imbalance) || !std::isfinite(a.l2_norm()))
        failure = "the energy or the acceleration is not finite";
    }
    catch (const NonPhysicalState &refusal) // the mean state may be physical although the state at the end is not
    {
      failure = refusal.what();
    }
  report_.load_steps.push_back(
    {static_cast<unsigned int>(n_steps_ + 1), step.last_load_factor, failure.empty(), failure});
  if (!failure.empty())
    return failure;
  displacement_ = u;
  velocity_ = v;
  acceleration_ = a;
  load_factor_ = step.last_load_factor;
  time_ = end;
  ledger_ = ledger;
  rate_forces_.set_history(std::move(history));
  branch_energies_ = branch_energies;
  return "";
}

void DynamicSolver::run_until(const double end, const Observer &observer)
{
  if (!std::isfinite(end))
    throw InvalidInput("the end time must be finite");
  // Within rounding of `end` the time counts as `end`.
  while (time_ < end - 1e-9 * settings_.time_step)
  {
    step();
    if (observer)
      observer();
  }
}

std::vector<Tensor<2, 2>> DynamicSolver::rate_stresses() const
{
  std::vector<Tensor<2, 2>> stresses;
  if (!rate_forces_.is_present())
    return stresses;
  stresses.resize(sheet_.mesh().n_locally_owned_active_cells() * QGauss<2>(sheet_.degree() + 1).size());
  rate_forces_.add_stresses(displacement_, velocity_, load(), stresses);
  return stresses;
}

std::vector<PointState> DynamicSolver::evaluate(const std::vector<Point<2>> &points) const
{
  return sheet_.evaluate(displacement_, points);
}
} // namespace latcon::continuum
