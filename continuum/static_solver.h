#pragma once

#include "continuum/linear_solver.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace latcon::continuum
{
/// Settings of StaticSolver.
struct StaticSettings
{
  unsigned int degree = 3;                 ///< polynomial degree p >= 1 of the elements; p >= 2 with a gradient law
  double relative_tolerance = 1e-10;       ///< residual over reference force [-], in (0, 1)
  unsigned int max_newton_iterations = 20; ///< per load step
  double first_load_step = 1.;             ///< first increment of the load factor [-], in (0, 1]
  double smallest_load_step = 1. / 1024.;  ///< increment below which the solve fails [-]
  /// Loosest tolerance of a linear system, residual relative to the right-hand side [-], in [0, 1). It avoids solving
  /// linear systems more accurately than the Newton step deserves (theory-continuum.md, "Weak form and Newton"). 0:
  /// solve each system to round-off.
  double largest_forcing = 1e-3;
  LinearSettings linear;
};

/// Solves for the static equilibrium of a sheet under boundary conditions and dead loads at finite strain (total
/// Lagrangian): the minimum of E(u) minus the work of the dead loads (theory-continuum.md, eq. (C.15)), continued from
/// the unloaded state at load factor 0 to load factor 1.
///
/// Each load step starts with a predictor, the linear response to the increment of load and prescribed displacement,
/// followed by Newton's method with backtracking on the energy. If systems are solved iteratively and the first load
/// step is 1, the equilibrium on the mesh coarsened once, computed in the same way, replaces the predictor unless that
/// fails. Only minima are wanted; the energy distinguishes them from saddle points, the norm of the residual does not.
/// A Newton step that leads to det F <= 0 anywhere is halved. A load step that does not converge is halved; after one
/// that converges fast the next one is larger.
///
/// The residual converges to relative_tolerance times the reference force (norm of the nodal reactions and dead loads),
/// or to the round-off of its own evaluation where that is larger (theory-continuum.md, eq. (C.19)).
///
/// All functions are collective. Every exception is thrown on every rank.
class StaticSolver
{
public:
  using Vector = Sheet::Vector;

  /// Function that is called after every accepted load step with the current load factor [-].
  using Observer = std::function<void(double load_factor)>;

  /// Creates a solver at load factor 0. `mesh` and the laws must outlive the solver. At a node with conflicting
  /// conditions the first condition in the list applies. Throws InvalidInput for settings out of range, if no
  /// displacement is prescribed, and as Sheet does.
  StaticSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
               const StaticSettings &settings = StaticSettings());

  /// Increases the load factor from 0 to 1. Throws SolverFailed with the history if that fails; the state is then the
  /// last accepted one.
  SolverReport solve(const Observer &observer = Observer());

  /// Refines the `fraction` [-] of the cells of `mesh`, the mesh of the sheet, with the largest indicators, eq. (C.33),
  /// and interpolates the state; equilibrate() then restores equilibrium. Throws InvalidInput for another mesh or a
  /// fraction outside (0, 1].
  void refine(Sheet::Mesh &mesh, double fraction);

  /// Finds the equilibrium at the current load factor from the current state, such as one interpolated by refine().
  /// Throws SolverFailed with the history; the state is then unchanged.
  SolverReport equilibrate();

  /// Returns the stored energy E [J/m] of the current state, per unit reference thickness.
  double total_energy() const;

  /// Returns the force [N/m] that each boundary with prescribed displacement exerts on the sheet, per unit reference
  /// thickness. Forces are sums of nodal residuals, so they balance exactly; a node on several held boundaries is
  /// divided between them according to their tractions (theory-continuum.md, eq. (C.18)).
  std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> reactions() const;

  /// Nodal displacement [m], with ghost entries.
  const Vector &displacement() const { return displacement_; }
  const Sheet &sheet() const { return sheet_; }
  double load_factor() const { return load_factor_; }

private:
  struct Evaluation;

  void set_up();
  Evaluation evaluate(const Vector &u, double load_factor) const;
  const Evaluation &current() const;
  double round_off(const Evaluation &state, const Vector &u) const;
  void start_from(Vector &u, double load_factor);
  bool solve_from_coarser_mesh(SolverReport &report);
  bool take_load_step(double target, SolverReport &report);
  std::string attempt(double target, SolverReport &report);

  Sheet sheet_;
  StaticSettings settings_;
  std::unique_ptr<LinearSolver> linear_solver_;
  Vector full_lift_;                              // prescribed displacement at load factor 1, zero elsewhere
  Vector loads_;                                  // nodal dead loads at load factor 1
  Vector displacement_;
  double load_factor_ = 0.;
  mutable std::shared_ptr<const Evaluation> current_; // at both; null: to be evaluated
};
} // namespace latcon::continuum
