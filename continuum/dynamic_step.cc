// Newton's method and energy balance for one time step of DynamicSolver.
#include "continuum/dynamic_step.h"

#include "continuum/errors.h"
#include "continuum/newton_solver.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

using namespace dealii;

namespace latcon::continuum
{
DynamicSolver::Residual DynamicSolver::evaluate(const Step &step, const Vector &u) const
{
  const Vector a_1 = step.last_acceleration(u);
  const Vector v_1 = step.last_velocity(a_1);
  Residual state{with_ghosts(Step::mean(step.rule.alpha_f, step.u, u)),
                 with_ghosts(Step::mean(step.rule.alpha_f, step.v, v_1)),
                 sheet_.make_owned(),
                 sheet_.make_owned(),
                 0.,
                 0.,
                 0.};
  Vector inertial = sheet_.make_owned();
  Vector forces = sheet_.make_owned();
  multiply_by_mass(full_mass_, Step::mean(step.rule.alpha_m, step.a, a_1), inertial);
  state.energy = sheet_.residual(state.u_mean, forces, state.magnitude);
  rate_forces_.add_forces(mean_duration(), state.u_mean, state.v_mean, forces, &state.magnitude);
  state.residual = inertial;
  state.residual += forces;
  state.residual.add(-1., loads_, -step.mean_release_share(), release_forces_);
  state.free = norm_over_free(sheet_, homogeneous_, [&](const auto i) { return std::pow(state.residual(i), 2); });
  state.reference = std::sqrt(inertial.norm_sqr() + forces.norm_sqr() + loads_.norm_sqr());
  Vector u_owned = sheet_.make_owned();
  u_owned = state.u_mean;
  state.energy -= loads_ * u_owned;
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
      if (homogeneous_.is_constrained(dof))
        return;
      const double value =
        std::isfinite(residual(dof)) ? std::abs(residual(dof)) : std::numeric_limits<double>::infinity();
      if (value > own[0])
        own = {value, X[0], X[1]};
    });
  const std::vector<Candidate> all = dealii::Utilities::MPI::all_gather(sheet_.communicator(), own);
  const Candidate largest = *std::max_element(all.begin(), all.end());
  std::ostringstream place;
  place << " at X = (" << largest[1] << ", " << largest[2] << ") m";
  return place.str();
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
void DynamicSolver::weigh_and_add_mass(const Sheet &sheet, const AffineConstraints<double> &constraints,
                                       AnyMatrix &K) const
{
  const NewmarkParameters &rule = settings_.rule;
  K *= 1. - rule.alpha_f;
  sheet.add_mass((1. - rule.alpha_m) / (rule.beta * duration_ * duration_) * inertia_.density, inertia_.length,
                 constraints, K);
}

// Returns the assembler of this derivative on a coarser mesh. The sheet is taken at rest, which drops the unsymmetric
// part of viscosity: it vanishes with the velocity. Maxwell branches are taken relaxed: coarser meshes have no history.
Assembler DynamicSolver::level_assembler() const
{
  return [=](const Sheet &level, const Vector &u, const AffineConstraints<double> &constraints, auto &K)
  {
    level.tangent(u, constraints, K);
    RateForces relaxed = rate_forces_.on(level);
    relaxed.start(u, {});
    relaxed.add_tangent(mean_duration(), u, level.make_ghosted(),
                        settings_.rule.gamma / (settings_.rule.beta * duration_), constraints, K);
    weigh_and_add_mass(level, constraints, K);
  };
}

// Returns the assembler of this derivative and its diagonals on the mesh of the sheet, at a mean velocity.
Assembler DynamicSolver::assembler(const Vector &v)
{
  return [&](const Sheet &, const Vector &u, const AffineConstraints<double> &constraints, auto &K)
  {
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
    weigh_and_add_mass(sheet_, constraints, K);
    take_diagonal(effective_diagonal_);
  };
}

void DynamicSolver::assemble(const Vector &u, const Vector &v)
{
  linear_solver_->update(u, assembler(v), level_assembler());
}

// Records the state at which the linear solver set up multigrid, if it has done so since the count `before`.
void DynamicSolver::record_multigrid_state(const unsigned int before, const Vector &u)
{
  if (linear_solver_->n_set_ups() != before)
    multigrid_displacement_ = u;
}

void DynamicSolver::restore_multigrid()
{
  const Vector at_rest = sheet_.make_ghosted();
  linear_solver_->restore(multigrid_displacement_, assembler(at_rest), level_assembler());
}

// Returns the round-off of the residual, eq. (C.45) [N/m].
double DynamicSolver::round_off(const Residual &state, const Vector &u) const
{
  const auto square = [&](const types::global_dof_index i)
  {
    // F = I + Grad u has a rounding error of epsilon even for small u, as in a wave of small amplitude.
    const double of_strain = elastic_diagonal_(i) * smallest_cell_;
    return std::pow(state.magnitude(i), 2) + std::pow(effective_diagonal_(i) * u(i), 2) + of_strain * of_strain;
  };
  return residual_round_off * norm_over_free(sheet_, homogeneous_, square);
}

void DynamicSolver::update_energies(EnergyLedger &ledger, const Vector &u, const Vector &v,
                                    const std::vector<BranchEnergy> &branches) const
{
  ledger.stored = sheet_.energy(with_ghosts(u));
  for (const BranchEnergy &branch : branches)
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

// Returns the ledger at the end of a step with displacement u, velocity v and energies of branches.
EnergyLedger DynamicSolver::ledger_after(const Step &step, const Vector &u, const Vector &v,
                                         const std::vector<BranchEnergy> &branches) const
{
  EnergyLedger ledger = ledger_;
  update_energies(ledger, u, v, branches);

  Vector rise = u;
  rise -= step.u;
  Vector rate = rise;
  rate *= 1. / step.dt;
  ledger.dissipated += step.dt * rate_forces_.dissipation(with_ghosts(Step::mean(0.5, step.u, u)), with_ghosts(rate));
  for (std::size_t i = 0; i < branches.size(); ++i)
    ledger.dissipated += branches[i].dissipated - branch_energies_[i].dissipated;

  // Nodes with prescribed displacement do not move.
  const double released = -0.5 * (step.first_release_share + step.last_release_share) * (release_forces_ * rise);
  ledger.released += released;
  ledger.work += loads_ * rise - released;
  ledger.imbalance = ledger.stored + ledger.kinetic + ledger.dissipated - ledger.work - initial_energy_;
  return ledger;
}

// Solves a step for the displacement `u` at its end. Returns the reason of failure, empty on success.
std::string DynamicSolver::attempt(Step &step, Vector &u)
{
  const unsigned int number = n_steps_ + 1;
  try
  {
    // Predictors of the free unknowns: constant acceleration (share 1), and no motion.
    const auto predicted = [&](const double share)
    {
      Vector rise = sheet_.make_owned();
      rise.add(share * step.dt, step.v, share * 0.5 * step.dt * step.dt, step.a);
      homogeneous_.distribute(rise);
      rise += step.u;
      return rise;
    };
    Residual state = best_residual(step, predicted(1.), predicted(0.), u);
    // So exact that one further solution, with a kept tangent, reaches the usual tolerance of a step.
    constexpr double largest_forcing = 1e-5;
    Vector tangent_at; // mean displacement of the tangent
    const auto solve =
      [&](const Residual &at, const Vector &, const double forcing, const bool keeps_tangent, Vector &change)
    {
      const unsigned int set_ups = linear_solver_->n_set_ups();
      if (!keeps_tangent)
      {
        assemble(at.u_mean, at.v_mean);
        tangent_at = at.u_mean;
      }
      Vector rhs = at.residual;
      rhs *= -1.;
      homogeneous_.set_zero(rhs);
      const unsigned int iterations = linear_solver_->solve(change, rhs, forcing);
      record_multigrid_state(set_ups, tangent_at);
      homogeneous_.distribute(change);
      return NewtonStep{iterations, 0.};
    };
    const NewtonSolver<Residual> newton(
      {settings_.relative_tolerance, settings_.max_newton_iterations, settings_.max_halvings, largest_forcing},
      {[&](const Vector &at) { return evaluate(step, at); },
       [this](const Residual &at, const Vector &there) { return round_off(at, there); }, solve, nullptr,
       [this](const Residual &at) { return ", the largest residual is" + location_of_largest(at.residual); }});
    return newton.solve(u, state, number, 1., 0, report_.iterations);
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
} // namespace latcon::continuum
