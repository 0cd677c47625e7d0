#pragma once

#include "continuum/direct_solver.h"
#include "continuum/multigrid.h"
#include "continuum/sheet.h"

#include <memory>

namespace latcon::continuum
{
/// Settings of LinearSolver.
struct LinearSettings
{
  /// Largest number of unknowns for the direct solver; larger systems use Krylov methods with multigrid. Sheets with
  /// periodic edges always use the direct solver.
  dealii::types::global_dof_index direct_limit = 20000;
  /// Tightest tolerance of a Krylov method, residual relative to the right-hand side [-], in (0, 1).
  double relative_tolerance = 1e-8;
  /// Krylov iterations per digit of the residual, relative to those with an up-to-date multigrid [-], >= 0, above which
  /// multigrid is rebuilt; 0: rebuild for every tangent.
  double rebuild_ratio = 1.5;
  /// Maximum number of Krylov iterations.
  unsigned int max_iterations = 200;
  /// Number of unknowns up to which a level of multigrid is solved directly.
  dealii::types::global_dof_index coarsest_size = 2000;
};

/// Symmetry of the matrices of a LinearSolver.
enum class Symmetry
{
  symmetric,  ///< and positive definite
  unsymmetric ///< slightly
};

/// Assembles the condensed tangent K of a sheet and solves K x = b, with DirectSolver or iteratively. The iterative
/// solver is conjugate gradients for symmetric K and GMRES for unsymmetric K, with a SinglePrecisionMatrix and
/// preconditioned by Multigrid. Coarser levels are reused for later tangents (of Newton, load and time steps) until the
/// iterations exceed LinearSettings::rebuild_ratio or fail. Reuse changes the cost and not the tolerance of the
/// solution.
class LinearSolver
{
public:
  /// Creates a solver for the tangents of `sheet`, condensed by its homogeneous_constraints(), which must outlive it.
  /// Throws InvalidInput for settings out of range.
  LinearSolver(const Sheet &sheet, const LinearSettings &settings, Symmetry symmetry = Symmetry::symmetric);

  /// Assembles K at the state `u` [m] (with ghost entries) by `assemble`, and sets up multigrid unless the existing one
  /// can be reused. `assemble_coarser` assembles the symmetric tangents of coarser meshes; solve() may call it as well.
  /// Collective.
  void update(const Sheet::Vector &u, const Assembler &assemble, const Assembler &assemble_coarser);

  /// Solves K x = b until the residual is at most `relative_tolerance` [-] times that of x = 0, or
  /// LinearSettings::relative_tolerance where that is larger; the direct solver ignores the tolerance. Collective.
  /// Returns the number of Krylov iterations, 0 for the direct solver. Throws LinearSolverFailed on every rank if the
  /// factorisation fails, the tolerance is not reached, or the solution is not finite.
  unsigned int solve(Sheet::Vector &x, const Sheet::Vector &b, double relative_tolerance = 0.);

  /// Returns the entry K_ii [N/m^2] of an owned row; 0 before the first update().
  double diag_element(dealii::types::global_dof_index i) const;

  /// Frees the memory of the matrix, its factors and multigrid until the next update().
  void release();

  /// Makes the next update() rebuild multigrid, because the matrices change substantially.
  void invalidate() { is_stale_ = true; }
  bool has_tangent() const { return !is_stale_ && (matrix_ || single_matrix_); } ///< of the last update()

  /// Saves the status of the reused multigrid to an archive or loads it from there.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("is_stale", is_stale_);
    archive("baseline_iterations", baseline_iterations_);
    archive("set_ups", n_set_ups_);
  }

  /// Returns true if the next update() will reuse multigrid.
  bool keeps_multigrid() const { return !is_direct_ && !is_stale_; }

  /// Nodal vector [m], with ghost entries, at which multigrid was set up last, to be archived as well.
  Sheet::Vector &multigrid_state() { return multigrid_state_; }

  /// Rebuilds the multigrid that an archived solver used, with the archived iteration counts. Collective. Throws as
  /// update() does.
  void restore(const Assembler &assemble, const Assembler &assemble_coarser);

  /// Returns how many times multigrid has been set up.
  unsigned int n_set_ups() const { return n_set_ups_; }
  bool is_direct() const { return is_direct_; }

private:
  void set_up();
  unsigned int iterate(Sheet::Vector &x, const Sheet::Vector &b, double relative_tolerance);

  const Sheet &sheet_;
  LinearSettings settings_;
  bool is_direct_;
  Symmetry symmetry_;
  // From the first update on:
  std::unique_ptr<Sheet::Matrix> matrix_;                // for the direct solver
  std::unique_ptr<SinglePrecisionMatrix> single_matrix_; // for the iterative one
  std::unique_ptr<DirectSolver> direct_;
  std::unique_ptr<Multigrid> multigrid_; // created on first use
  unsigned int n_set_ups_ = 0;
  Sheet::Vector state_;           // of the last update
  Sheet::Vector multigrid_state_; // of the last set-up
  Assembler assemble_coarser_;
  bool is_fresh_ = false;           // set up, or factorised, since the last update
  bool is_stale_ = true;            // to be rebuilt in the next update
  double baseline_iterations_ = 0.; // iterations per digit with an up-to-date multigrid
};
} // namespace latcon::continuum
