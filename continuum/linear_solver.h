#pragma once

#include "continuum/sheet.h"

#include <memory>

namespace continuum
{
/// How linear systems are solved.
struct LinearSettings
{
  /// Largest number of unknowns for the direct solver; above it, conjugate gradients with algebraic multigrid.
  dealii::types::global_dof_index direct_limit = 60000;
  /// Residual of conjugate gradients relative to the right-hand side [-], in (0, 1).
  double relative_tolerance = 1e-8;
  /// Conjugate-gradient iterations before giving up.
  unsigned int max_iterations = 500;
};

/// Solves K x = b for the symmetric positive definite, condensed tangent of a sheet. Direct: Amesos with MUMPS, or KLU
/// where MUMPS is missing. Iterative: conjugate gradients, preconditioned by smoothed aggregation (ML) that is
/// given the six affine fields as near-null space, because elasticity needs rotations and constants alone do not
/// coarsen it.
class LinearSolver
{
public:
  LinearSolver(const Sheet &sheet, const LinearSettings &settings);
  ~LinearSolver();
  LinearSolver(const LinearSolver &) = delete;
  LinearSolver &operator=(const LinearSolver &) = delete;

  /// Collective. Returns the conjugate-gradient iterations, 0 when direct. Throws LinearSolverFailed on every rank if
  /// the factorisation fails, the tolerance is not met, or the answer is not finite.
  unsigned int solve(const Sheet::Matrix &K, Sheet::Vector &x, const Sheet::Vector &b) const;

  bool is_direct() const { return is_direct_; }

private:
  struct NearNullSpace;

  LinearSettings settings_;
  bool is_direct_;
  MPI_Comm communicator_;
  std::unique_ptr<NearNullSpace> near_null_space_;
};
} // namespace continuum
