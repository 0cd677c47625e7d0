#pragma once

#include "continuum/errors.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
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
  unsigned int max_halvings;   ///< of one Newton step in the line search
  /// Largest residual of a linear system relative to its right-hand side [-], in [0, 1); 0: each system is solved to
  /// round-off.
  double largest_forcing = 0.;
};

/// Linear solution of a Newton step.
struct NewtonStep
{
  unsigned int linear_iterations; ///< 0 if direct
  double slope;                   ///< dE along the step [J/m]; used only if the energy has to fall
};

/// Newton's method with a line search that halves the step (theory-continuum.md, "Weak form and Newton"). Statics and
/// dynamics state their equations as functions of the nodal displacement u [m]; the solver decides on tolerance,
/// forcing, step length and failure.
///
/// `State` is what an evaluation of the residual leaves, with members
///   free       norm of the residual over the free unknowns [N/m],
///   reference  norm of the forces at work [N/m],
///   energy     energy less the work of dead loads [J/m].
/// All functions are collective.
template <class State>
class NewtonSolver
{
public:
  using Vector = Sheet::Vector;

  /// The equations. Those marked optional may be empty.
  struct Equations
  {
    /// Evaluates the residual at u. @throws NonPhysicalState where the residual has no value: the step is halved
    std::function<State(const Vector &u)> evaluate;
    /// Round-off of the residual at u [N/m]: the tolerance is not below it.
    std::function<double(const State &state, const Vector &u)> round_off;
    /// Solves for the Newton step at u to the relative residual `forcing`. @throws LinearSolverFailed
    std::function<NewtonStep(const State &state, const Vector &u, double forcing, Vector &step)> solve;
    /// Round-off of the energy of a state [J/m]. If given, the line search asks for a decrease of the energy, as a
    /// minimum requires; if empty (optional), any state that can be evaluated is accepted.
    std::function<double(const State &state)> energy_noise;
    /// Words on a state that did not converge, appended to the reason (optional).
    std::function<std::string(const State &state)> describe;
  };

  NewtonSolver(const NewtonSettings &settings, Equations equations)
    : settings_(settings), equations_(std::move(equations))
  {
  }

  /// Iterates from u, at which the residual is `state`, to a solution, which u becomes. Every evaluation is appended to
  /// `history` with the step's `number` and `load_factor` and, for the first, the `linear_iterations` of the predictor.
  /// @return why it failed, empty if it converged; u is then the last accepted iterate
  std::string solve(Vector &u, State state, unsigned int number, double load_factor, unsigned int linear_iterations,
                    std::vector<NewtonIteration> &history) const;

private:
  /// Halves the step until its end is acceptable. Returns why none is, empty if one is.
  std::string search(const Vector &step, double slope, Vector &u, State &state, double &length) const;
  double next_forcing(double last, double reduction, double tolerance) const;

  NewtonSettings settings_;
  Equations equations_;
};

template <class State>
std::string NewtonSolver<State>::solve(Vector &u, State state, const unsigned int number, const double load_factor,
                                       unsigned int linear_iterations, std::vector<NewtonIteration> &history) const
{
  Vector step(u);
  double length = 1.;
  double forcing = settings_.largest_forcing;
  double last_free = state.free;
  for (unsigned int iteration = 0;; ++iteration)
  {
    const double tolerance = std::max(settings_.relative_tolerance * state.reference, equations_.round_off(state, u));
    history.push_back({number, iteration, load_factor, state.free, tolerance, state.energy, length, linear_iterations});
    if (state.free <= tolerance)
      return "";
    if (iteration == settings_.max_iterations)
      return "no convergence in " + std::to_string(iteration) + " Newton iterations" +
             (equations_.describe ? equations_.describe(state) : "");

    forcing = next_forcing(forcing, state.free / last_free, tolerance / state.free);
    last_free = state.free;
    const NewtonStep solved = equations_.solve(state, u, forcing, step);
    linear_iterations = solved.linear_iterations;
    if (equations_.energy_noise && !(solved.slope < 0.))
      return "the tangent is not positive definite along the Newton step";
    if (const std::string failure = search(step, solved.slope, u, state, length); !failure.empty())
      return failure;
  }
}

template <class State>
std::string NewtonSolver<State>::search(const Vector &step, const double slope, Vector &u, State &state,
                                        double &length) const
{
  constexpr double sufficient = 1e-4; // share of the linear decrease, after Armijo
  const double start = state.energy;
  const double noise = equations_.energy_noise ? equations_.energy_noise(state) : 0.;
  length = 1.;
  std::string reason;
  for (unsigned int halvings = 0; halvings <= settings_.max_halvings; ++halvings, length *= 0.5)
    try
    {
      Vector trial = u;
      trial.add(length, step);
      State candidate = equations_.evaluate(trial);
      const bool is_accepted =
        !equations_.energy_noise || candidate.energy <= start + sufficient * length * slope + noise;
      if (is_accepted)
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
  if (!equations_.energy_noise)
    return reason;
  return "the line search found no decrease of energy" + (reason.empty() ? "" : "; last refused state: " + reason);
}

/// Relative residual to which the next Newton step is solved, after Eisenstat and Walker (1996), choice 2 with its
/// safeguard: as the residual falls quadratically, by the square of its last reduction. `tolerance` is that of the
/// residual relative to its value. A step that comes close to it anyway is made to reach it, and none goes far below.
template <class State>
double NewtonSolver<State>::next_forcing(const double last, const double reduction, const double tolerance) const
{
  constexpr double share = 0.9;
  double forcing = share * reduction * reduction;
  if (const double kept = share * last * last; kept > 0.1)
    forcing = std::max(forcing, kept);
  const double last_step = 0.1 * tolerance;
  if (forcing < 1e3 * last_step)
    forcing = last_step;
  return std::min(settings_.largest_forcing, forcing);
}
} // namespace latcon::continuum
