#pragma once

#include "continuum/sheet.h"

#include <memory>
#include <optional>

namespace latcon::continuum
{
/// LU factorisation of a matrix whose rows are distributed over ranks. The root rank gathers the matrix and factorises
/// it alone, because the rounding of a parallel factorisation depends on the order in which messages arrive, and a
/// restart needs the same bits for the same matrix.
///
/// The symbolic factorisation of the first matrix is reused; the reuse does not change the solution by a bit.
///
/// All functions are collective and throw on every rank, LinearSolverFailed unless stated otherwise.
class DirectSolver
{
public:
  /// Library that computes the factors.
  enum class Library
  {
    mumps, ///< falls back to KLU if MUMPS is not available
    klu    ///< slower for large matrices, faster solution for small ones
  };

  /// @param memory that the factorisation may take [bytes]; none: what is available at the time
  explicit DirectSolver(Library library = Library::mumps, std::optional<double> memory = std::nullopt);
  ~DirectSolver();
  DirectSolver(const DirectSolver &) = delete;
  DirectSolver &operator=(const DirectSolver &) = delete;

  /// Factorises a copy of `K`, which has the sparsity of the matrices before. Throws LinearSolverFailed if `K` is
  /// singular, and InvalidInput, before it is factorised, if MUMPS estimates that it needs more memory than there is.
  void factorise(const Sheet::Matrix &K);

  /// Solves K x = b for the last factorised matrix; the vectors have no ghost entries.
  template <class Vector>
  void solve(Vector &x, const Vector &b)
  {
    solve(x.begin(), b.begin());
  }

private:
  struct Factors;

  void solve(double *x, const double *b);

  Library library_;
  std::optional<double> memory_; // [bytes]
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::unique_ptr<Factors> factors_;
};
} // namespace latcon::continuum
