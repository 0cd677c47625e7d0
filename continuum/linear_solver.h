#pragma once

#include "continuum/direct_solver.h"
#include "continuum/multigrid.h"
#include "continuum/sheet.h"

#include <memory>

namespace latcon::continuum
{
/// How linear systems are solved.
struct LinearSettings
{
  /// Largest number of unknowns for the direct solver; above it, Krylov methods with multigrid. Periodic edges are left
  /// to the direct solver whatever the size.
  dealii::types::global_dof_index direct_limit = 20000;
  /// Smallest residual of a Krylov method relative to the right-hand side that is asked for [-], in (0, 1).
  double relative_tolerance = 1e-8;
  /// Iterations for the digits of the residual, over those with a multigrid that is up to date [-], >= 0, beyond which
  /// multigrid is set up anew; 0: for every tangent.
  double rebuild_ratio = 1.5;
  /// Krylov iterations before giving up.
  unsigned int max_iterations = 200;
  MultigridSettings multigrid;
};

/// Which matrices a LinearSolver is given.
enum class Symmetry
{
  symmetric,  ///< and positive definite
  unsymmetric ///< by little: Multigrid::Assembler makes a symmetric positive definite matrix that is close
};

/// Solves K x = b for the condensed tangent of a sheet. Directly: by DirectSolver.
/// Iteratively: conjugate gradients for symmetric K, GMRES for others, preconditioned by Multigrid of the symmetric
/// matrix. A multigrid is kept for the tangents that follow (of further Newton, load and time steps) until it is worn:
/// until the iterations have grown beyond LinearSettings::rebuild_ratio, or fail. That changes the work and not what is
/// solved.
class LinearSolver
{
public:
  /// `sheet` must outlive the solver, `held` says what is held besides. Throws InvalidInput for settings out of range.
  LinearSolver(const Sheet &sheet, DirichletBoundaries held, const LinearSettings &settings,
               Symmetry symmetry = Symmetry::symmetric);

  /// To be called when K has changed, before the next solve: takes note of the state `u` [m] (with ghost entries) and
  /// sets up multigrid if there is none that serves. `assemble` makes the tangents of coarser meshes and, for
  /// unsymmetric K, the symmetric one of the sheet itself; it is called in solve, too. Collective.
  void update(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble);

  /// The residual comes to at most `relative_tolerance` [-] times that of x = 0, but no smaller one is asked for than
  /// LinearSettings::relative_tolerance; the direct solver ignores it. Collective. Returns the Krylov iterations, 0
  /// when direct. Throws LinearSolverFailed on every rank if the factorisation fails, the tolerance is not met, or the
  /// answer is not finite.
  unsigned int solve(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b, double relative_tolerance = 0.);

  /// Has multigrid set up anew at the next update: the matrices that follow are of another kind.
  void invalidate() { is_stale_ = true; }

  /// Stores what is known of the multigrid that is kept, or takes it from there.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("is_stale", is_stale_);
    archive("baseline_iterations", baseline_iterations_);
    archive("set_ups", n_set_ups_);
  }

  /// Whether the next update leaves multigrid as it is.
  bool keeps_multigrid() const { return !is_direct_ && !is_stale_; }

  /// Makes the multigrid that another solver kept when it was archived: set up at the state `u` [m] and its matrix `K`,
  /// and as worn as it was. Collective. Throws as update.
  void restore(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble);

  /// How often multigrid was set up.
  unsigned int n_set_ups() const { return n_set_ups_; }
  bool is_direct() const { return is_direct_; }

private:
  void set_up(const Sheet::Matrix &K);
  unsigned int iterate(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b, double relative_tolerance);

  const Sheet &sheet_;
  DirichletBoundaries held_;
  LinearSettings settings_;
  bool is_direct_;
  Symmetry symmetry_;
  DirectSolver direct_;
  std::unique_ptr<Multigrid> multigrid_; // made when first needed
  unsigned int n_set_ups_ = 0;
  Sheet::Vector state_;
  Multigrid::Assembler assemble_;
  bool is_fresh_ = false;           // whether multigrid is that of the last update
  bool is_stale_ = true;            // whether it has to be set up anew
  double baseline_iterations_ = 0.; // iterations for each digit with a fresh multigrid
};
} // namespace latcon::continuum
