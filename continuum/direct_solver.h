#pragma once

#include "continuum/sheet.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <memory>

namespace latcon::continuum
{
/// LU factors of a matrix whose rows are spread over ranks. The first rank gathers it and factorises it alone: factors
/// that ranks share are rounded as messages happen to arrive, and the same matrix has to give the same bits every time
/// for a motion to be resumed. Sheets are plane, so their factors fit one rank.
///
/// The analysis of a sparsity is kept for the matrices that follow, and changes no bit of what is solved.
///
/// All functions are collective, and throw LinearSolverFailed on every rank.
class DirectSolver
{
public:
  /// Which library factorises.
  enum class Library
  {
    mumps, ///< KLU where MUMPS is missing
    klu    ///< slower for large matrices, faster to solve with small ones
  };

  explicit DirectSolver(Library library = Library::mumps);
  ~DirectSolver();
  DirectSolver(const DirectSolver &) = delete;
  DirectSolver &operator=(const DirectSolver &) = delete;

  /// Factorises a copy of `K`. Throws if it is singular.
  void factorise(const Sheet::Matrix &K);

  /// Solves K x = b for the matrix factorised last; the vectors have no ghost entries.
  void solve(Sheet::Vector &x, const Sheet::Vector &b);
  void solve(dealii::LinearAlgebra::distributed::Vector<double> &x,
             const dealii::LinearAlgebra::distributed::Vector<double> &b);

private:
  struct Factors; // of the first rank

  void solve(double *x, const double *b);

  Library library_;
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::size_t n_own_ = 0; // rows
  std::unique_ptr<Factors> factors_;
};
} // namespace latcon::continuum
