// Newton's method and energy balance for one time step of DynamicSolver.
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/newton_solver.h"
#include "support/text_wrap.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

using namespace dealii;

namespace latcon::continuum
{
// State at the beginning of a step (vectors without ghost entries), and Newmark's formulas for its end.
struct DynamicSolver::Step
{
  NewmarkParameters rule;
  double dt;
  Vector u;
  Vector v;
  Vector a;
  double first_release_share;
  double last_release_share;

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

// Residual of the equation of motion for a given displacement at the end of a step.
struct DynamicSolver::Residual
{
  Vector u_mean;    // with ghost entries [m]
  Vector v_mean;    // with ghost entries [m/s]
  Vector residual;  // [N/m]
  Vector magnitude; // sums of the absolute values of its terms [N/m]
  double free = 0.; // norm of the residual over the free unknowns [N/m]
  double reference = 0.; // norm of internal, viscous and inertial forces and loads over all unknowns [N/m]
  double energy = 0.;    // of the mean state, minus the work of dead loads [J/m]
};

DynamicSolver::Residual DynamicSolver::evaluate(const Step &step, const Vector &u) const
{
  const Vector a_1 = step.last_acceleration(u);
  const Vector v_1 = step.last_velocity(a_1);
  Residual state{sheet_.with_ghosts(Step::mean(step.rule.alpha_f, step.u, u)),
                 sheet_.with_ghosts(Step::mean(step.rule.alpha_f, step.v, v_1)), sheet_.make_owned(),
                 sheet_.make_owned()};
  Vector inertial = sheet_.make_owned();
  Vector forces = sheet_.make_owned();
  multiply_by_mass(full_mass_, Step::mean(step.rule.alpha_m, step.a, a_1), inertial);
  state.energy = sheet_.residual(state.u_mean, forces, state.magnitude);
  rate_forces_.add_forces(mean_duration(), state.u_mean, state.v_mean, forces, &state.magnitude);
  state.residual = inertial;
  state.residual += forces;
  const double release_share =
    step.rule.alpha_f * step.first_release_share + (1. - step.rule.alpha_f) * step.last_release_share;
  state.residual.add(-1., loads_, -release_share, release_forces_);
  state.free = norm_over_free(sheet_, [&](const auto i) { return std::pow(state.residual(i), 2); });
  state.reference = std::sqrt(inertial.norm_sqr() + forces.norm_sqr() + loads_.norm_sqr());
  state.energy -= loads_ * sheet_.without_ghosts(state.u_mean);
  if (!std::isfinite(state.free) || !std::isfinite(state.reference))
    throw NonPhysicalState("forces are not finite" + location_of_largest(state.residual));
  return state;
}

// Describes the location of the largest residual of a free unknown; NaN counts as the largest.
std::string DynamicSolver::location_of_largest(const Vector &residual) const
{
  using Candidate = std::array<double, 3>; // absolute value [N/m], position [m]
  Candidate own{-1., 0., 0.};
  sheet_.for_each_owned_dof(
    [&](const auto dof, unsigned int, const Point<2> &X)
    {
      if (sheet_.homogeneous_constraints().is_constrained(dof))
        return;
      const double value =
        std::isfinite(residual(dof)) ? std::abs(residual(dof)) : std::numeric_limits<double>::infinity();
      if (value > own[0])
        own = {value, X[0], X[1]};
    });
  const std::vector<Candidate> all = dealii::Utilities::MPI::all_gather(sheet_.communicator(), own);
  const Candidate largest = *std::max_element(all.begin(), all.end());
  return support::text_of(" at X = (", largest[1], ", ", largest[2], ") m");
}

// Evaluates two predictors, sets `u` to the better one and returns its residual. Constant acceleration is accurate to
// third order if the step resolves the motion and inaccurate for long steps; the second predictor is evaluated only if
// the first does not reduce the forces.
DynamicSolver::Residual DynamicSolver::best_residual(const Step &step, const Vector &first, const Vector &second,
                                                     Vector &u) const
{
  std::optional<Residual> best;
  for (const Vector *predicted : {&first, &second})
    try
    {
      Residual state = evaluate(step, *predicted);
      if (!best || state.free < best->free)
      {
        best = std::move(state);
        u = *predicted;
      }
      if (best->free <= 0.1 * best->reference)
        break;
    }
    catch (const NonPhysicalState &)
    {
      if (predicted == &second && !best)
        throw;
    }
  return *best;
}

// Turns the derivative K of the mean forces by the mean displacement into that of the residual by the displacement at
// the end of the step.
template <class AnyMatrix>
void DynamicSolver::weigh_and_add_mass(const Sheet &sheet, AnyMatrix &K) const
{
  const NewmarkParameters &rule = settings_.rule;
  K *= 1. - rule.alpha_f;
  sheet.add_mass((1. - rule.alpha_m) / (rule.beta * duration_ * duration_) * inertia_.density, inertia_.length,
                 sheet.homogeneous_constraints(), K);
}

// Returns the assembler of this derivative on a coarser mesh. The sheet is taken at rest, which drops the unsymmetric
// part of viscosity: it vanishes with the velocity. Maxwell branches are taken relaxed: coarser meshes have no history.
Assembler DynamicSolver::level_assembler() const
{
  return [=](const Sheet &level, const Vector &u, auto &K)
  {
    const AffineConstraints<double> &constraints = level.homogeneous_constraints();
    level.tangent(u, constraints, K);
    RateForces relaxed = rate_forces_.on(level);
    relaxed.start(u, {});
    relaxed.add_tangent(mean_duration(), u, level.make_ghosted(),
                        settings_.rule.gamma / (settings_.rule.beta * duration_), constraints, K);
    weigh_and_add_mass(level, K);
  };
}

// Returns the assembler of this derivative and its diagonals on the mesh of the sheet, at a mean velocity.
Assembler DynamicSolver::assembler(const Vector &v)
{
  return [&](const Sheet &, const Vector &u, auto &K)
  {
    const AffineConstraints<double> &constraints = sheet_.homogeneous_constraints();
    const auto take_diagonal = [&](Vector &diagonal)
    {
      for (const types::global_dof_index i : sheet_.owned())
        diagonal(i) = K.diag_element(i);
      diagonal.compress(VectorOperation::insert);
    };
    sheet_.tangent(u, constraints, K);
    take_diagonal(elastic_diagonal_);
    rate_forces_.add_tangent(mean_duration(), u, v, settings_.rule.gamma / (settings_.rule.beta * duration_),
                             constraints, K);
    weigh_and_add_mass(sheet_, K);
    take_diagonal(effective_diagonal_);
  };
}

// Returns the round-off of the residual, eq. (C.45) [N/m].
double DynamicSolver::round_off(const Residual &state, const Vector &u) const
{
  return residual_round_off(sheet_, state.magnitude, u, effective_diagonal_, elastic_diagonal_);
}

// Updates the energies of a state; v is its velocity.
void DynamicSolver::update_energies(State &state, const Vector &v) const
{
  EnergyLedger &ledger = state.ledger;
  ledger.stored = sheet_.energy(state.displacement);
  for (const BranchEnergy &branch : state.branch_energies)
    ledger.stored += branch.stored;
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

// Updates the ledger, that at the beginning of a step, for the state at its end with displacement u and velocity v.
void DynamicSolver::update_ledger(const Step &step, const Vector &u, const Vector &v, State &state) const
{
  EnergyLedger &ledger = state.ledger;
  update_energies(state, v);

  Vector rise = u;
  rise -= step.u;
  Vector rate = rise;
  rate *= 1. / step.dt;
  ledger.dissipated +=
    step.dt * rate_forces_.dissipation(sheet_.with_ghosts(Step::mean(0.5, step.u, u)), sheet_.with_ghosts(rate));
  for (std::size_t i = 0; i < state.branch_energies.size(); ++i)
    ledger.dissipated += state.branch_energies[i].dissipated - state_.branch_energies[i].dissipated;

  // Nodes with prescribed displacement do not move.
  const double released = -0.5 * (step.first_release_share + step.last_release_share) * (release_forces_ * rise);
  ledger.released += released;
  ledger.work += loads_ * rise - released;
  ledger.imbalance = ledger.stored + ledger.kinetic + ledger.dissipated - ledger.work - initial_energy_;
}

// Solves a step for the displacement `u` at its end. Returns the reason of failure, empty on success.
std::string DynamicSolver::attempt(const Step &step, Vector &u)
{
  const unsigned int number = report_.load_steps.size() + 1;
  try
  {
    // Predictors of the free unknowns: constant acceleration (share 1), and no motion.
    const auto predicted = [&](const double share)
    {
      Vector rise = sheet_.make_owned();
      rise.add(share * step.dt, step.v, share * 0.5 * step.dt * step.dt, step.a);
      sheet_.homogeneous_constraints().distribute(rise);
      rise += step.u;
      return rise;
    };
    Residual state = best_residual(step, predicted(1.), predicted(0.), u);
    // So exact that one further solution, with a kept tangent, reaches the usual tolerance of a step.
    constexpr double largest_forcing = 1e-5;
    const auto solve =
      [&, has_tangent = settings_.keeps_tangent && linear_solver_->has_tangent()](
        const Residual &at, const Vector &, const double forcing, const bool keeps_tangent, Vector &change) mutable
    {
      if (!std::exchange(has_tangent, false) && !keeps_tangent)
        linear_solver_->update(at.u_mean, assembler(at.v_mean), level_assembler());
      Vector rhs = at.residual;
      rhs *= -1.;
      sheet_.homogeneous_constraints().set_zero(rhs);
      const unsigned int iterations = linear_solver_->solve(change, rhs, forcing);
      sheet_.homogeneous_constraints().distribute(change);
      return NewtonStep{iterations, 0.};
    };
    const NewtonSolver<Residual> newton{
      {settings_.relative_tolerance, settings_.max_newton_iterations, largest_forcing},
      {[&](const Vector &at) { return evaluate(step, at); },
       [this](const Residual &at, const Vector &there) { return round_off(at, there); }, solve, nullptr,
       [this](const Residual &at) { return ", the largest residual is" + location_of_largest(at.residual); }}};
    return newton.solve(u, state, number, 1., 0, report_.iterations);
  }
  catch (const NoSolution &failure)
  {
    return failure.what();
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
  const Step step{settings_.rule,
                  duration,
                  sheet_.without_ghosts(state_.displacement),
                  sheet_.without_ghosts(state_.velocity),
                  sheet_.without_ghosts(state_.acceleration),
                  release_share(state_.time),
                  release_share(end)};
  Vector u = sheet_.make_owned();
  State next = state_;
  next.time = end;
  RateForces::History history;
  std::string failure = attempt(step, u);
  if (failure.empty())
    try
    {
      const Vector a = step.last_acceleration(u);
      const Vector v = step.last_velocity(a);
      next.displacement = u;
      next.velocity = v;
      next.acceleration = a;
      history = rate_forces_.advanced(duration, next.displacement, next.branch_energies);
      update_ledger(step, u, v, next);
      if (!std::isfinite(next.ledger.imbalance) || !std::isfinite(a.l2_norm()))
        failure = "the energy or the acceleration is not finite";
    }
    catch (const NonPhysicalState &refusal) // the mean state may be physical although the state at the end is not
    {
      failure = refusal.what();
    }
  report_.load_steps.push_back(
    {static_cast<unsigned int>(report_.load_steps.size() + 1), 1., failure.empty(), failure});
  if (failure.empty())
  {
    state_ = std::move(next);
    rate_forces_.set_history(std::move(history));
  }
  return failure;
}
} // namespace latcon::continuum
