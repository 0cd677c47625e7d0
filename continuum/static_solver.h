#pragma once

#include "continuum/linear_solver.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace latcon::continuum
{
/// How the nonlinear problem is solved.
struct StaticSettings
{
  unsigned int degree = 3;                 ///< of the elements, p >= 1; p >= 2 with a gradient law
  double relative_tolerance = 1e-10;       ///< residual over reference force [-], in (0, 1)
  unsigned int max_newton_iterations = 20; ///< per load step
  unsigned int max_halvings = 10;          ///< of the Newton step in one line search
  double first_load_step = 1.;             ///< first rise of the load factor [-], in (0, 1]
  double smallest_load_step = 1. / 1024.;  ///< rise below which the solve fails [-]
  /// Largest residual of a linear system relative to its right-hand side [-], in [0, 1): what is solved more closely
  /// than a Newton step is good for is lost work (theory-continuum.md, "Weak form and Newton"). 0: each to the last.
  double largest_forcing = 1e-3;
  LinearSettings linear;
};

/// Static equilibrium of a sheet under boundary conditions and dead loads, at finite strain, total Lagrangian: the
/// minimum of E(u) less the work of the dead loads (theory-continuum.md, eq. (C.15)), followed from the unloaded state
/// at load factor 0 to load factor 1.
///
/// Each load step starts from the linear response to the rise of load and boundary displacement (predictor), then
/// Newton with backtracking on the energy: the equilibria wanted are minima, and the energy tells them from saddle
/// points, as the norm of the residual does not. A step that leaves det F <= 0 anywhere is halved. A load step that
/// does not converge is cut in two; one that converges fast makes the next one larger.
///
/// The residual is held to relative_tolerance times the reference force (norm of the nodal reactions and dead
/// loads), or to the round-off of its own evaluation where that is larger (theory-continuum.md, eq. (C.19)).
///
/// All functions are collective, and every exception reaches every rank.
class StaticSolver
{
public:
  using Vector = Sheet::Vector;

  /// Called after every accepted load step, with the load factor [-] reached.
  using Observer = std::function<void(double load_factor)>;

  /// `mesh` and the laws must outlive the solver. Throws InvalidInput for settings out of range, no prescribed
  /// displacement, or what Sheet refuses. Where boundaries meet and disagree, the first in the list holds the
  /// common node.
  StaticSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
               const StaticSettings &settings = StaticSettings());

  /// Loads from zero to the full displacement. Throws SolverFailed with the history if that cannot be done; the state
  /// is then the last accepted one.
  SolverReport solve(const Observer &observer = Observer());

  /// Refines the `fraction` [-] of the cells of `mesh` (that of the sheet) where the error seems largest and takes the
  /// state along; equilibrate() makes it an equilibrium of the refined mesh. Throws InvalidInput for another mesh or a
  /// fraction outside (0, 1].
  void refine(Sheet::Mesh &mesh, double fraction);

  /// Finds the equilibrium at the present load factor from the present state, or if Newton fails there, by loading from
  /// zero. Throws SolverFailed as solve() does.
  SolverReport equilibrate();

  /// Stored energy E [J/m] of the present state, per unit reference thickness.
  double total_energy() const;

  /// Force [N/m] that each boundary with a prescribed displacement exerts on the sheet, per unit reference thickness:
  /// sums of the nodal residuals, so that they balance exactly. A node where held boundaries meet is shared between
  /// them by their tractions (theory-continuum.md, eq. (C.18)).
  std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> reactions() const;

  /// Range of the in-plane det F [-] over the quadrature points.
  DeterminantRange determinant_range() const;

  /// States at reference points [m]; see Sheet::evaluate.
  std::vector<PointState> evaluate(const std::vector<dealii::Point<2>> &points) const;

  /// Nodal displacement [m], with ghost entries.
  const Vector &displacement() const { return displacement_; }
  const Sheet &sheet() const { return sheet_; }
  double load_factor() const { return load_factor_; }

private:
  struct Evaluation;

  void check_input() const;
  void set_up();
  Evaluation evaluate(const Vector &u, double load_factor) const;
  double round_off(const Evaluation &state, const Vector &u) const;
  std::string attempt(double target, SolverReport &report);

  Sheet sheet_;
  StaticSettings settings_;
  std::unique_ptr<LinearSolver> linear_solver_;
  dealii::AffineConstraints<double> homogeneous_; // hanging nodes, and held unknowns at zero
  Vector full_lift_;                              // prescribed displacement at load factor 1, zero elsewhere
  Vector loads_;                                  // nodal dead loads at load factor 1
  Sheet::Matrix matrix_;
  Vector displacement_;
  double load_factor_ = 0.;
};
} // namespace latcon::continuum
