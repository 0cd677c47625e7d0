#pragma once

#include "continuum/multigrid.h"
#include "continuum/sheet.h"

#include <memory>

namespace continuum
{
/// How linear systems are solved.
struct LinearSettings
{
  /// Largest number of unknowns for the direct solver; above it, conjugate gradients with multigrid. Periodic edges are
  /// left to the direct solver whatever the size.
  dealii::types::global_dof_index direct_limit = 20000;
  /// Residual of conjugate gradients relative to the right-hand side [-], in (0, 1).
  double relative_tolerance = 1e-8;
  /// Conjugate-gradient iterations before giving up.
  unsigned int max_iterations = 200;
  MultigridSettings multigrid;
};

/// Solves K x = b for the condensed tangent of a sheet. Direct: Amesos with MUMPS, or KLU where MUMPS is missing.
/// Iterative, for symmetric positive definite K: conjugate gradients, preconditioned by Multigrid.
class LinearSolver
{
public:
  /// `sheet` must outlive the solver, `held` says what is held besides. Throws InvalidInput for settings out of range.
  LinearSolver(const Sheet &sheet, HeldBoundaries held, const LinearSettings &settings);

  /// To be called when K has changed: takes over the state `u` [m] (with ghost entries) and its tangent, which must
  /// stay as it is until the last solve. `assemble` makes the tangents of coarser meshes. Collective.
  void update(const Sheet::Vector &u, const Sheet::Matrix &K, const Multigrid::Assembler &assemble);

  /// Collective. Returns the conjugate-gradient iterations, 0 when direct. Throws LinearSolverFailed on every rank if
  /// the factorisation fails, the tolerance is not met, or the answer is not finite.
  unsigned int solve(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b) const;

  bool is_direct() const { return is_direct_; }

private:
  const Sheet &sheet_;
  HeldBoundaries held_;
  LinearSettings settings_;
  bool is_direct_;
  std::unique_ptr<Multigrid> multigrid_; // made when first needed
};
} // namespace continuum
