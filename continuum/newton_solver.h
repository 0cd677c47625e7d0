#pragma once

#include "continuum/errors.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace latcon::continuum
{
/// Limits of Newton's method for one load step or time step.
struct NewtonSettings
{
  double relative_tolerance;   ///< residual over reference force [-], in (0, 1)
  unsigned int max_iterations; ///< Newton steps
  /// Loosest tolerance of a linear system, residual relative to the right-hand side [-], in [0, 1); 0: solve each
  /// system to round-off.
  double largest_forcing = 0.;
};

/// Outcome of the linear solve for a Newton step.
struct NewtonStep
{
  unsigned int linear_iterations; ///< 0 if direct
  double slope; ///< directional derivative of the energy along the step [J/m]; used only if energy_noise is given
};

/// Returns the square root of the sum of `square(i)` over the free unknowns i. Collective.
template <class Square>
double norm_over_free(const Sheet &sheet, const Square &square)
{
  double sum = 0.;
  for (const dealii::types::global_dof_index i : sheet.owned())
    if (!sheet.homogeneous_constraints().is_constrained(i))
      sum += square(i);
  return std::sqrt(dealii::Utilities::MPI::sum(sum, sheet.communicator()));
}

/// Returns the round-off of a residual [N/m], eqs. (C.19) and (C.45). Factor 4: computing a stress adds several
/// rounding errors to those of the displacement. Collective.
/// @param magnitude sum of the absolute values of its terms [N/m] @param u nodal displacement [m]
/// @param tangent,elastic entry (i, i) of the matrix and of its elastic part for unknown i [N/m^2]
template <class Tangent, class Elastic>
double residual_round_off(const Sheet &sheet, const Sheet::Vector &magnitude, const Sheet::Vector &u,
                          const Tangent &tangent, const Elastic &elastic)
{
  const auto square = [&](const dealii::types::global_dof_index i)
  {
    // F = I + Grad u has a rounding error of epsilon even for small u, as in a wave of small amplitude.
    return std::pow(magnitude(i), 2) + std::pow(tangent(i) * u(i), 2) + std::pow(elastic(i) * sheet.smallest_cell(), 2);
  };
  return 4. * std::numeric_limits<double>::epsilon() * norm_over_free(sheet, square);
}

/// Newton's method with a line search that halves the step (theory-continuum.md, "Weak form and Newton"). StaticSolver
/// and DynamicSolver pass their equations as functions of the nodal displacement u [m]; this class controls tolerance,
/// forcing, step length and failure.
///
/// `State` is the result of an evaluation of the residual, with members
///   free       norm of the residual over the free unknowns [N/m],
///   reference  norm of the acting forces [N/m],
///   energy     energy minus the work of dead loads [J/m].
/// All functions are collective.
template <class State>
class NewtonSolver
{
public:
  using Vector = Sheet::Vector;

  /// Equations to solve. Functions marked optional may be empty.
  struct Equations
  {
    /// Evaluates the residual at u. @throws NonPhysicalState if the residual is undefined there; the step is then
    /// halved
    std::function<State(const Vector &u)> evaluate;
    /// Returns the round-off of the residual at u [N/m], a lower bound of the tolerance.
    std::function<double(const State &state, const Vector &u)> round_off;
    /// Solves for the Newton step at u to the relative residual `forcing`, with the tangent of the last step if that
    /// is kept. @throws LinearSolverFailed
    std::function<NewtonStep(const State &state, const Vector &u, double forcing, bool keeps_tangent, Vector &step)>
      solve;
    /// Returns the round-off of the energy of a state [J/m] (optional). If given, the line search requires a decrease
    /// of the energy, which leads to a minimum; if empty, a decrease of the norm of the residual.
    std::function<double(const State &state)> energy_noise;
    /// Returns a description of a state that did not converge, appended to the reason of failure (optional).
    std::function<std::string(const State &state)> describe;
  };

  NewtonSettings settings;
  Equations equations;

  /// Iterates from u, with residual `state`, and overwrites both with those of the solution. Appends every evaluation
  /// to `history` with the `number` and `load_factor` of the step; the first gets the `linear_iterations` of the
  /// predictor.
  /// @return reason of failure, empty if converged; after a failure u is the last accepted iterate
  std::string solve(Vector &u, State &state, const unsigned int number, const double load_factor,
                    unsigned int linear_iterations, std::vector<NewtonIteration> &history) const
  {
    Vector step(u);
    double length = 1.;
    double last_free = state.free;
    for (unsigned int iteration = 0;; ++iteration)
    {
      const double tolerance = std::max(settings.relative_tolerance * state.reference, equations.round_off(state, u));
      history.push_back(
        {number, iteration, load_factor, state.free, tolerance, state.energy, length, linear_iterations});
      if (state.free <= tolerance)
        return "";
      if (iteration == settings.max_iterations)
        return "no convergence in " + std::to_string(iteration) + " Newton iterations" +
               (equations.describe ? equations.describe(state) : "");

      const double reduction = state.free / last_free;
      last_free = state.free;
      const double forcing = next_forcing(reduction, tolerance / state.free);
      const NewtonStep solved = equations.solve(state, u, forcing, reduction <= fast_reduction, step);
      linear_iterations = solved.linear_iterations;
      if (equations.energy_noise && !(solved.slope < 0.))
        return "the tangent is not positive definite along the Newton step";
      if (const std::string failure = search(step, solved.slope, tolerance, u, state, length); !failure.empty())
        return failure;
    }
  }

private:
  /// Ratio of residuals below which the tangent has hardly changed, and the energy decreases by less than its
  /// round-off.
  static constexpr double fast_reduction = 0.01;

  /// Halves the step until its end is accepted: always if its residual is below `tolerance` [N/m], or has fallen fast.
  /// Returns the reason of failure, empty on success.
  std::string search(const Vector &step, const double slope, const double tolerance, Vector &u, State &state,
                     double &length) const
  {
    constexpr double sufficient = 1e-4; // Armijo constant
    const double start = state.energy;
    const double noise = equations.energy_noise ? equations.energy_noise(state) : 0.;
    const auto is_accepted = [&](const State &candidate)
    {
      if (candidate.free <= std::max(fast_reduction * state.free, tolerance))
        return true;
      if (equations.energy_noise)
        return candidate.energy <= start + sufficient * length * slope + noise;
      // Along an exact Newton step the residual falls as 1 - length.
      return candidate.free <= (1. - sufficient * length) * state.free;
    };
    constexpr unsigned int max_halvings = 10;
    length = 1.;
    std::string reason;
    for (unsigned int halvings = 0; halvings <= max_halvings; ++halvings, length *= 0.5)
      try
      {
        Vector trial = u;
        trial.add(length, step);
        State candidate = equations.evaluate(trial);
        if (is_accepted(candidate))
        {
          state = std::move(candidate);
          u = trial;
          return "";
        }
      }
      catch (const NonPhysicalState &failure)
      {
        reason = failure.what();
      }
    return std::string("the line search found no decrease of ") + (equations.energy_noise ? "energy" : "the residual") +
           (reason.empty() ? "" : "; last refused state: " + reason);
  }

  /// Returns the forcing term of the next Newton step after Eisenstat and Walker (1996), choice 2: proportional to the
  /// square of the last reduction of the residual. `tolerance` is the tolerance of the residual
  /// relative to its value. A step that would almost reach the tolerance is solved accurately enough to reach it; no
  /// step is solved much more accurately.
  double next_forcing(const double reduction, const double tolerance) const
  {
    constexpr double share = 0.9;
    double forcing = share * reduction * reduction;
    const double last_step = 0.1 * tolerance;
    if (forcing < 1e3 * last_step)
      forcing = last_step;
    return std::min(settings.largest_forcing, forcing);
  }
};
} // namespace latcon::continuum
