#include "continuum/dynamic_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace dealii;

namespace continuum
{
/// What is known when a step begins, all without ghost entries, and Newmark's formulas from there.
struct DynamicSolver::Step
{
  TimeRule rule;
  double dt;
  Vector u;
  Vector v;
  Vector a;
  double first_load_factor;
  double last_load_factor;

  double mean_load_factor() const { return rule.alpha_f * first_load_factor + (1. - rule.alpha_f) * last_load_factor; }

  Vector last_acceleration(const Vector &last_u) const
  {
    Vector a_1 = last_u;
    a_1 -= u;
    a_1.add(-dt, v);
    a_1.sadd(1. / (rule.beta * dt * dt), 1. - 0.5 / rule.beta, a);
    return a_1;
  }

  Vector last_velocity(const Vector &last_acceleration) const
  {
    Vector v_1 = v;
    v_1.add(dt * (1. - rule.gamma), a, dt * rule.gamma, last_acceleration);
    return v_1;
  }

  static Vector mean(const double first_share, const Vector &first, const Vector &last)
  {
    Vector x = last;
    x.sadd(1. - first_share, first_share, first);
    return x;
  }
};

/// The equation of motion at a displacement of the end of a step.
struct DynamicSolver::Balance
{
  Vector u_mean;    // with ghost entries [m]
  Vector v_mean;    // with ghost entries [m/s]
  Vector residual;  // [N/m]
  Vector magnitude; // sums of absolute values behind it [N/m]
  double free;      // norm of the residual over the free unknowns [N/m]
  double reference; // norm of internal, viscous and inertial forces and of loads, of every unknown [N/m]
  double energy;    // of the mean state, less the work of dead loads [J/m]
};

TimeRule TimeRule::generalised_alpha(const double rho_inf)
{
  if (!(rho_inf >= 0. && rho_inf <= 1.))
    throw InvalidInput("the amplification rho_inf of high frequencies must lie between 0 and 1");
  const double alpha_m = (2. * rho_inf - 1.) / (rho_inf + 1.);
  const double alpha_f = rho_inf / (rho_inf + 1.);
  const double gamma = 0.5 - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * (0.5 + gamma) * (0.5 + gamma), gamma};
}

DynamicSolver::DynamicSolver(const Sheet::Mesh &mesh, const Constitution &constitution, Conditions conditions,
                             const Inertia &inertia, const DynamicSettings &settings, const Viscosity *viscosity,
                             LoadFactor load_factor)
  : sheet_(mesh, constitution, settings.degree, std::move(conditions)), inertia_(inertia), settings_(settings),
    viscosity_(viscosity), viscous_forces_(sheet_, viscosity), given_load_factor_(std::move(load_factor))
{
  check_input();
  set_up();
}

void DynamicSolver::check_input() const
{
  const auto require = [](const bool holds, const std::string &rule)
  {
    if (!holds)
      throw InvalidInput(rule);
  };
  require(inertia_.density > 0. && std::isfinite(inertia_.density), "the density must be positive and finite");
  require(inertia_.length >= 0. && std::isfinite(inertia_.length),
          "the length of micro-inertia must be finite and not negative");
  require(settings_.time_step > 0. && std::isfinite(settings_.time_step), "the time step must be positive and finite");
  require(settings_.relative_tolerance > 0. && settings_.relative_tolerance < 1.,
          "the relative tolerance of the residual must lie between 0 and 1");
  const TimeRule &rule = settings_.rule;
  constexpr double rounding = 1e-12;
  require(rule.alpha_m <= rule.alpha_f + rounding && rule.alpha_f <= 0.5 + rounding && rule.alpha_f >= 0. &&
            rule.beta >= 0.25 + 0.5 * (rule.alpha_f - rule.alpha_m) - rounding && std::isfinite(rule.beta),
          "a time rule is stable only with alpha_m <= alpha_f <= 1/2 and beta >= 1/4 + (alpha_f - alpha_m)/2");
  require(std::abs(rule.gamma - (0.5 - rule.alpha_m + rule.alpha_f)) <= rounding,
          "a time rule is of second order only with gamma = 1/2 - alpha_m + alpha_f");
}

// Everything that depends on the mesh.
void DynamicSolver::set_up()
{
  full_lift_ = sheet_.lift();
  const HeldBoundaries held = held_boundaries(sheet_.conditions());
  homogeneous_.copy_from(homogeneous_constraints(sheet_, held));

  loads_ = sheet_.loads();
  sheet_.make_matrix(homogeneous_, matrix_);
  sheet_.make_matrix(homogeneous_, mass_);
  sheet_.mass(inertia_.density, inertia_.length, homogeneous_, mass_);
  sheet_.make_matrix(sheet_.continuity(), full_mass_);
  sheet_.mass(inertia_.density, inertia_.length, sheet_.continuity(), full_mass_);
  if (inertia_.length > 0.)
  {
    sheet_.make_matrix(sheet_.continuity(), plain_mass_);
    sheet_.mass(inertia_.density, 0., sheet_.continuity(), plain_mass_);
  }
  // Viscosity at finite strain makes the matrix unsymmetric, which conjugate gradients cannot solve.
  LinearSettings linear = settings_.linear;
  if (viscosity_ != nullptr)
    linear.direct_limit = std::numeric_limits<types::global_dof_index>::max();
  linear_solver_ = std::make_unique<LinearSolver>(sheet_, held, linear);

  double smallest = std::numeric_limits<double>::infinity();
  for (const auto &cell : sheet_.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      smallest = std::min(smallest, cell->minimum_vertex_distance());
  smallest_cell_ = Utilities::MPI::min(smallest, sheet_.communicator());

  displacement_ = sheet_.make_ghosted();
  velocity_ = sheet_.make_ghosted();
  acceleration_ = sheet_.make_ghosted();
  elastic_diagonal_ = sheet_.make_owned();
  effective_diagonal_ = sheet_.make_owned();
}

double DynamicSolver::load_factor_at(const double time) const
{
  double factor = 1.;
  collectively(sheet_.communicator(),
               [&]
               {
                 if (given_load_factor_)
                   factor = given_load_factor_(time);
                 if (!std::isfinite(factor))
                   throw InvalidInput("the load factor at time " + std::to_string(time) + " s is not finite");
               });
  return factor;
}

DynamicSolver::Vector DynamicSolver::ghosted(const Vector &owned) const
{
  Vector x = sheet_.make_ghosted();
  x = owned;
  return x;
}

// Nodal values, made one field across hanging nodes; not across periodic edges, for the field may be affine.
DynamicSolver::Vector DynamicSolver::interpolate(const VectorField &field) const
{
  Vector x = sheet_.make_owned();
  if (field)
  {
    const GuardedWork guarded(
      [&]
      {
        if (field->n_components != 2)
          throw InvalidInput("an initial field needs a function of two components");
        const auto &element = sheet_.element();
        std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
        for (const auto &cell : sheet_.dof_handler().active_cell_iterators())
          if (cell->is_locally_owned())
          {
            cell->get_dof_indices(dofs);
            for (unsigned int a = 0; a < dofs.size(); ++a)
              if (sheet_.owned().is_element(dofs[a]))
                x(dofs[a]) =
                  field->value(sheet_.mapping().transform_unit_to_real_cell(cell, element.unit_support_point(a)),
                               element.system_to_component_index(a).first);
          }
      });
    x.compress(VectorOperation::insert);
    guarded.agree(sheet_.communicator());
  }
  AffineConstraints<double> hanging(sheet_.relevant());
  DoFTools::make_hanging_node_constraints(sheet_.dof_handler(), hanging);
  hanging.close();
  hanging.distribute(x);
  return x;
}

// Rows of dependent unknowns, which hold what AffineConstraints needs to keep the matrix regular, are left out.
void DynamicSolver::multiply_by_mass(const Sheet::Matrix &M, const Vector &x, Vector &product) const
{
  M.vmult(product, x);
  for (const types::global_dof_index i : sheet_.owned())
    if (sheet_.continuity().is_constrained(i))
      product(i) = 0.;
  product.compress(VectorOperation::insert);
}

double DynamicSolver::norm_over_free(const Vector &x) const
{
  double sum = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!homogeneous_.is_constrained(i))
      sum += x(i) * x(i);
  return std::sqrt(Utilities::MPI::sum(sum, sheet_.communicator()));
}

void DynamicSolver::start(const VectorField &displacement, const VectorField &velocity, const double time)
{
  Vector u = interpolate(displacement);
  Vector v = interpolate(velocity);
  begin(u, v, time);
}

void DynamicSolver::start(const Vector &displacement, const Vector &velocity, const double time)
{
  if (displacement.size() != sheet_.dof_handler().n_dofs() || velocity.size() != sheet_.dof_handler().n_dofs())
    throw InvalidInput("an initial nodal vector must be one of the sheet");
  Vector u = sheet_.make_owned();
  Vector v = sheet_.make_owned();
  u = displacement;
  v = velocity;
  begin(u, v, time);
}

void DynamicSolver::begin(Vector &u, Vector &v, const double time)
{
  if (!std::isfinite(time) || !std::isfinite(u.l2_norm()) || !std::isfinite(v.l2_norm()))
    throw InvalidInput("the initial time, displacement and velocity must be finite");
  const double dt = settings_.time_step;
  double factors[4]; // at the start and after one, two, three steps
  for (unsigned int k = 0; k < 4; ++k)
    factors[k] = load_factor_at(time + k * dt);

  double extent = 0.;
  for (const auto &cell : sheet_.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int vertex : cell->vertex_indices())
        extent = std::max(extent, cell->vertex(vertex).norm());
  extent = Utilities::MPI::max(extent, sheet_.communicator());

  // Held unknowns follow the load factor; one-sided differences of second order, like the time rule.
  const double rate = (-3. * factors[0] + 4. * factors[1] - factors[2]) / (2. * dt);
  const double second_rate = (2. * factors[0] - 5. * factors[1] + 4. * factors[2] - factors[3]) / (dt * dt);
  Vector a = sheet_.make_owned();
  double off = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (homogeneous_.is_constrained(i) && !sheet_.continuity().is_constrained(i))
    {
      off = std::max(off, std::abs(u(i) - factors[0] * full_lift_(i)));
      u(i) = factors[0] * full_lift_(i);
      v(i) = rate * full_lift_(i);
      a(i) = second_rate * full_lift_(i);
    }
  if (Utilities::MPI::max(off, sheet_.communicator()) > 1e-8 * extent)
    throw InvalidInput("the initial displacement of a held boundary is not the prescribed one");
  u.compress(VectorOperation::insert);
  v.compress(VectorOperation::insert);
  a.compress(VectorOperation::insert);
  sheet_.continuity().distribute(v);
  sheet_.continuity().distribute(a);

  // M a = lambda L - internal and viscous forces, with a given where held.
  const Vector u_ghosted = ghosted(u);
  const Vector v_ghosted = ghosted(v);
  Vector rhs = sheet_.make_owned();
  Vector forces = sheet_.make_owned();
  Vector magnitude = sheet_.make_owned();
  multiply_by_mass(full_mass_, a, rhs);
  sheet_.residual(u_ghosted, forces, magnitude, factors[0]);
  viscous_forces_.add_forces(u_ghosted, v_ghosted, forces, nullptr);
  rhs += forces;
  rhs.add(-factors[0], loads_);
  rhs *= -1.;
  for (const types::global_dof_index i : sheet_.owned())
    if (homogeneous_.is_constrained(i))
      rhs(i) = 0.;
  rhs.compress(VectorOperation::insert);
  Vector free_acceleration = sheet_.make_owned();
  linear_solver_->update(u_ghosted, mass_,
                         [this](const Sheet &level, const Vector &, const AffineConstraints<double> &constraints,
                                Sheet::Matrix &M) { level.mass(inertia_.density, inertia_.length, constraints, M); });
  linear_solver_->solve(mass_, free_acceleration, rhs);
  homogeneous_.distribute(free_acceleration);
  a += free_acceleration;

  // The diagonals that the floor of the residual needs before the first Newton step.
  const Step at_start{settings_.rule, dt, u, v, a, factors[0], factors[0]};
  assemble(at_start, {u_ghosted, v_ghosted, forces, magnitude, 0., 0., 0.});

  displacement_ = u_ghosted;
  velocity_ = v_ghosted;
  acceleration_ = a;
  start_time_ = time_ = time;
  n_steps_ = 0;
  load_factor_ = factors[0];
  ledger_ = EnergyLedger();
  report_ = SolverReport();
  take_stock(ledger_, u, v, load_factor_);
  initial_energy_ = ledger_.stored + ledger_.kinetic;
  has_started_ = true;
}

DynamicSolver::Balance DynamicSolver::look_at(const Step &step, const Vector &u) const
{
  const Vector a_1 = step.last_acceleration(u);
  const double factor = step.mean_load_factor();
  Balance state{ghosted(Step::mean(step.rule.alpha_f, step.u, u)),
                ghosted(Step::mean(step.rule.alpha_f, step.v, step.last_velocity(a_1))),
                sheet_.make_owned(),
                sheet_.make_owned(),
                0.,
                0.,
                0.};
  Vector inertial = sheet_.make_owned();
  Vector forces = sheet_.make_owned();
  multiply_by_mass(full_mass_, Step::mean(step.rule.alpha_m, step.a, a_1), inertial);
  sheet_.residual(state.u_mean, forces, state.magnitude, factor);
  viscous_forces_.add_forces(state.u_mean, state.v_mean, forces, &state.magnitude);
  state.residual = inertial;
  state.residual += forces;
  state.residual.add(-factor, loads_);
  state.free = norm_over_free(state.residual);
  state.reference = std::sqrt(inertial.norm_sqr() + forces.norm_sqr() + factor * factor * loads_.norm_sqr());
  Vector u_owned = sheet_.make_owned();
  u_owned = state.u_mean;
  state.energy = sheet_.energy(state.u_mean, factor) - factor * (loads_ * u_owned);
  return state;
}

// The better of two predictors, which `u` becomes. Constant acceleration is close to third order when the step resolves
// the motion and far off when it is long; the second is looked at only where the first does not reduce the forces.
DynamicSolver::Balance DynamicSolver::best_balance(const Step &step, const Vector &first, const Vector &second,
                                                   Vector &u) const
{
  std::unique_ptr<Balance> state;
  try
  {
    state = std::make_unique<Balance>(look_at(step, first));
    u = first;
    if (state->free <= 0.1 * state->reference)
      return *state;
  }
  catch (const NonPhysicalState &)
  {
    u = second;
    return look_at(step, second);
  }
  try
  {
    Balance other = look_at(step, second);
    if (other.free < state->free)
    {
      u = second;
      return other;
    }
  }
  catch (const NonPhysicalState &)
  {
  }
  return *state;
}

// The derivative of the residual by the displacement at the end of the step, and its diagonals.
void DynamicSolver::assemble(const Step &step, const Balance &state)
{
  const auto take_diagonal = [&](Vector &diagonal)
  {
    for (const types::global_dof_index i : sheet_.owned())
      diagonal(i) = matrix_.diag_element(i);
    diagonal.compress(VectorOperation::insert);
  };
  const TimeRule &rule = step.rule;
  sheet_.tangent(state.u_mean, homogeneous_, matrix_, step.mean_load_factor());
  take_diagonal(elastic_diagonal_);
  viscous_forces_.add_tangent(state.u_mean, state.v_mean, rule.gamma / (rule.beta * step.dt), homogeneous_, matrix_);
  const double stiffness_share = 1. - rule.alpha_f;
  const double mass_share = (1. - rule.alpha_m) / (rule.beta * step.dt * step.dt);
  matrix_ *= stiffness_share;
  matrix_.add(mass_share, mass_);
  take_diagonal(effective_diagonal_);
  const double load_factor = step.mean_load_factor();
  linear_solver_->update(
    state.u_mean, matrix_,
    [=](const Sheet &level, const Vector &u, const AffineConstraints<double> &constraints, Sheet::Matrix &K)
    {
      Sheet::Matrix M;
      level.make_matrix(constraints, M);
      level.mass(inertia_.density, inertia_.length, constraints, M);
      level.tangent(u, constraints, K, load_factor);
      K *= stiffness_share;
      K.add(mass_share, M);
    });
}

// The floor of eq. (C.45).
double DynamicSolver::round_off(const Balance &state, const Vector &u) const
{
  double sum = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!homogeneous_.is_constrained(i))
    {
      const double of_stress = state.magnitude(i);
      const double of_displacement = effective_diagonal_(i) * u(i);
      // F = I + Grad u is rounded to epsilon even where u is small, as in a small wave.
      const double of_strain = elastic_diagonal_(i) * smallest_cell_;
      sum += of_stress * of_stress + of_displacement * of_displacement + of_strain * of_strain;
    }
  // Four: a stress takes several roundings after those of the displacement.
  return 4. * std::numeric_limits<double>::epsilon() * std::sqrt(Utilities::MPI::sum(sum, sheet_.communicator()));
}

// Solves a step for the displacement `u` at its end. Returns why not, empty if solved.
std::string DynamicSolver::attempt(Step &step, Vector &u)
{
  const unsigned int number = n_steps_ + 1;
  try
  {
    // Two predictors for the free unknowns: constant acceleration, and no motion.
    const auto predicted = [&](const double share)
    {
      Vector rise = sheet_.make_owned();
      rise.add(share * step.dt, step.v, share * 0.5 * step.dt * step.dt, step.a);
      for (const types::global_dof_index i : sheet_.owned())
        if (homogeneous_.is_constrained(i) && !sheet_.continuity().is_constrained(i))
          rise(i) = step.last_load_factor * full_lift_(i) - step.u(i);
      rise.compress(VectorOperation::insert);
      sheet_.continuity().distribute(rise);
      rise += step.u;
      return rise;
    };
    Balance state = best_balance(step, predicted(1.), predicted(0.), u);
    double length = 1.;
    unsigned int linear_iterations = 0;
    Vector change = sheet_.make_owned();
    for (unsigned int iteration = 0;; ++iteration)
    {
      const double tolerance = std::max(settings_.relative_tolerance * state.reference, round_off(state, u));
      report_.iterations.push_back(
        {number, iteration, step.last_load_factor, state.free, tolerance, state.energy, length, linear_iterations});
      if (state.free <= tolerance)
        return "";
      if (iteration == settings_.max_newton_iterations)
        return "no convergence in " + std::to_string(iteration) + " Newton iterations";

      assemble(step, state);
      Vector rhs = state.residual;
      rhs *= -1.;
      for (const types::global_dof_index i : sheet_.owned())
        if (homogeneous_.is_constrained(i))
          rhs(i) = 0.;
      rhs.compress(VectorOperation::insert);
      linear_iterations = linear_solver_->solve(matrix_, change, rhs);
      homogeneous_.distribute(change);

      length = 1.;
      for (unsigned int halvings = 0;; ++halvings, length *= 0.5)
        try
        {
          Vector trial = u;
          trial.add(length, change);
          state = look_at(step, trial);
          u = trial;
          break;
        }
        catch (const NonPhysicalState &failure)
        {
          if (halvings == settings_.max_halvings)
            return failure.what();
        }
    }
  }
  catch (const NonPhysicalState &failure)
  {
    return failure.what();
  }
  catch (const LinearSolverFailed &failure)
  {
    return failure.what();
  }
}

void DynamicSolver::take_stock(EnergyLedger &ledger, const Vector &u, const Vector &v, const double load_factor) const
{
  ledger.stored = sheet_.energy(ghosted(u), load_factor);
  Vector momenta = sheet_.make_owned();
  multiply_by_mass(full_mass_, v, momenta);
  ledger.kinetic = 0.5 * (momenta * v);
  ledger.micro_kinetic = 0.;
  if (inertia_.length > 0.)
  {
    multiply_by_mass(plain_mass_, v, momenta);
    ledger.micro_kinetic = ledger.kinetic - 0.5 * (momenta * v);
  }
}

// The ledger after a step that ends with u and v.
EnergyLedger DynamicSolver::settled(const Step &step, const Vector &u, const Vector &v) const
{
  EnergyLedger ledger = ledger_;
  take_stock(ledger, u, v, step.last_load_factor);

  Vector rise = u;
  rise -= step.u;
  const Vector middle = ghosted(Step::mean(0.5, step.u, u));
  Vector rate = rise;
  rate *= 1. / step.dt;
  const Vector middle_velocity = ghosted(rate);
  ledger.dissipated += step.dt * viscous_forces_.dissipation(middle, middle_velocity);

  const double factor = 0.5 * (step.first_load_factor + step.last_load_factor);
  ledger.work += factor * (loads_ * rise);
  if (step.first_load_factor != step.last_load_factor)
  {
    if (!sheet_.conditions().normal_gradients.empty())
      ledger.work += sheet_.energy(middle, step.last_load_factor) - sheet_.energy(middle, step.first_load_factor);
    if (!sheet_.conditions().displacements.empty())
    {
      // Reactions at the middle of the step, where the accelerations of the rule are not of second order.
      Vector forces = sheet_.make_owned();
      Vector inertial = sheet_.make_owned();
      Vector magnitude = sheet_.make_owned();
      sheet_.residual(middle, forces, magnitude, factor);
      viscous_forces_.add_forces(middle, middle_velocity, forces, nullptr);
      Vector change = v;
      change -= step.v;
      change *= 1. / step.dt;
      multiply_by_mass(full_mass_, change, inertial);
      double own = 0.;
      for (const types::global_dof_index i : sheet_.owned())
        if (homogeneous_.is_constrained(i) && !sheet_.continuity().is_constrained(i))
          own += (forces(i) + inertial(i) - factor * loads_(i)) * rise(i);
      ledger.work += Utilities::MPI::sum(own, sheet_.communicator());
    }
  }
  ledger.imbalance = ledger.stored + ledger.kinetic + ledger.dissipated - ledger.work - initial_energy_;
  return ledger;
}

void DynamicSolver::step()
{
  if (!has_started_)
    throw InvalidInput("a motion needs a start before its first step");
  const double target = start_time_ + (n_steps_ + 1) * settings_.time_step;
  Step step{settings_.rule,      settings_.time_step, sheet_.make_owned(),   sheet_.make_owned(),
            sheet_.make_owned(), load_factor_,        load_factor_at(target)};
  step.u = displacement_;
  step.v = velocity_;
  step.a = acceleration_;
  report_ = SolverReport();
  Vector u = sheet_.make_owned();
  Vector v;
  Vector a;
  EnergyLedger ledger;
  std::string failure = attempt(step, u);
  if (failure.empty())
    try
    {
      a = step.last_acceleration(u);
      v = step.last_velocity(a);
      ledger = settled(step, u, v);
    }
    catch (const NonPhysicalState &refusal) // the mean state may be one where that at the end is not
    {
      failure = refusal.what();
    }
  report_.load_steps.push_back(
    {static_cast<unsigned int>(n_steps_ + 1), step.last_load_factor, failure.empty(), failure});
  report_.load_factor = failure.empty() ? step.last_load_factor : load_factor_;
  if (!failure.empty())
    throw SolverFailed("the time step from " + std::to_string(time_) + " s failed: " + failure, report_);

  displacement_ = u;
  velocity_ = v;
  acceleration_ = a;
  load_factor_ = step.last_load_factor;
  time_ = target;
  ++n_steps_;
  ledger_ = ledger;
}

void DynamicSolver::run_until(const double end, const Observer &observer)
{
  if (!std::isfinite(end))
    throw InvalidInput("the end of a motion must be finite");
  // An end within rounding of a step is met by it.
  while (time_ < end - 1e-9 * settings_.time_step)
  {
    step();
    if (observer)
      observer();
  }
}

Tensor<1, 2> DynamicSolver::momentum() const
{
  Vector v = sheet_.make_owned();
  v = velocity_;
  Vector momenta = sheet_.make_owned();
  multiply_by_mass(full_mass_, v, momenta);
  Tensor<1, 2> sum;
  for (unsigned int i = 0; i < 2; ++i)
  {
    ComponentMask mask(2, false);
    mask.set(i, true);
    for (const types::global_dof_index dof : DoFTools::extract_dofs(sheet_.dof_handler(), mask))
      if (sheet_.owned().is_element(dof))
        sum[i] += momenta(dof);
  }
  return Utilities::MPI::sum(sum, sheet_.communicator());
}

std::vector<PointState> DynamicSolver::evaluate(const std::vector<Point<2>> &points) const
{
  return sheet_.evaluate(displacement_, points);
}
} // namespace continuum
