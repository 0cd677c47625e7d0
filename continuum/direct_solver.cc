#include "continuum/direct_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "support/machine_memory.h"

#include <deal.II/base/mpi.h>

#include <Amesos.h>
#include <Amesos_Mumps.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

#include <algorithm>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// Consecutive rows of a matrix, with global column indices.
struct MatrixRows
{
  std::vector<int> lengths;
  std::vector<int> columns;
  std::vector<double> values;
};

void require_success(const int code, const char *what)
{
  if (code != 0)
    throw LinearSolverFailed(std::string("the linear solver failed: ") + what + " with code " + std::to_string(code));
}

// Checks the estimate of the symbolic factorisation before memory is taken: otherwise the system would end the process.
void require_memory(Amesos_BaseSolver &solver, const std::size_t n_rows, const std::optional<double> &memory)
{
  auto *mumps = dynamic_cast<Amesos_Mumps *>(&solver);
  if (mumps == nullptr)
    return;
  constexpr unsigned int working_space = 15; // INFOG(16), in millions of bytes
  const double needed = 1e6 * mumps->GetINFOG()[working_space];
  const double available = memory ? *memory : support::available_memory();
  if (needed > available)
    throw InvalidInput("not enough memory: the direct solver would take about " + support::readable_bytes(needed) +
                       " for " + std::to_string(n_rows) + " unknowns on one rank, and " +
                       support::readable_bytes(available) +
                       " are available; use fewer unknowns or, without periodic edges, a smaller direct limit");
}

MatrixRows own_rows(const Epetra_CrsMatrix &matrix)
{
  MatrixRows rows;
  rows.lengths.reserve(matrix.NumMyRows());
  rows.columns.reserve(matrix.NumMyNonzeros());
  rows.values.reserve(matrix.NumMyNonzeros());
  for (int row = 0; row < matrix.NumMyRows(); ++row)
  {
    int n = 0;
    double *values = nullptr;
    int *columns = nullptr;
    matrix.ExtractMyRowView(row, n, values, columns);
    rows.lengths.push_back(n);
    rows.values.insert(rows.values.end(), values, values + n);
    for (int k = 0; k < n; ++k)
      rows.columns.push_back(matrix.GCID(columns[k]));
  }
  return rows;
}

template <class T>
std::vector<T> concatenate(std::vector<std::vector<T>> &&parts)
{
  std::vector<T> all;
  if (!parts.empty())
    all = std::move(parts.front());
  for (std::size_t rank = 1; rank < parts.size(); ++rank)
    all.insert(all.end(), parts[rank].begin(), parts[rank].end());
  return all;
}

// Gathers the rows of all ranks on the root rank; returns none on other ranks.
MatrixRows gather_rows(const Epetra_CrsMatrix &matrix, const MPI_Comm communicator)
{
  MatrixRows own = own_rows(matrix);
  if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1)
    return own;
  return {concatenate(dealii::Utilities::MPI::gather(communicator, own.lengths)),
          concatenate(dealii::Utilities::MPI::gather(communicator, own.columns)),
          concatenate(dealii::Utilities::MPI::gather(communicator, own.values))};
}
} // namespace

// Matrix on the root rank and its factors. Amesos refers to the matrix as long as the factors exist, hence a copy.
struct DirectSolver::Factors
{
  Factors(MatrixRows &&rows, const Library library, const std::optional<double> &memory)
    : lengths(std::move(rows.lengths)), columns(std::move(rows.columns)),
      map(static_cast<int>(lengths.size()), 0, Epetra_MpiComm(MPI_COMM_SELF)),
      matrix(Copy, map, map, lengths.data(), true), x(map), b(map)
  {
    std::size_t at = 0;
    for (std::size_t row = 0; row < lengths.size(); at += lengths[row++])
      matrix.InsertMyValues(static_cast<int>(row), lengths[row], rows.values.data() + at, columns.data() + at);
    matrix.FillComplete();
    problem.SetOperator(&matrix);
    problem.SetLHS(&x);
    problem.SetRHS(&b);
    Amesos factory;
    const bool uses_mumps = library == Library::mumps && factory.Query("Amesos_Mumps");
    solver.reset(factory.Create(uses_mumps ? "Amesos_Mumps" : "Amesos_Klu", problem));
    require_success(solver->SymbolicFactorization(), "symbolic factorisation");
    require_memory(*solver, lengths.size(), memory);
  }

  bool has_sparsity_of(const MatrixRows &rows) const { return rows.lengths == lengths && rows.columns == columns; }

  void replace_values(const MatrixRows &rows)
  {
    std::size_t at = 0;
    for (std::size_t row = 0; row < lengths.size(); at += lengths[row++])
      matrix.ReplaceMyValues(static_cast<int>(row), lengths[row], rows.values.data() + at, columns.data() + at);
  }

  std::vector<int> lengths; // number of entries per row
  std::vector<int> columns;
  Epetra_Map map;
  Epetra_CrsMatrix matrix;
  Epetra_Vector x;
  Epetra_Vector b;
  Epetra_LinearProblem problem;
  std::unique_ptr<Amesos_BaseSolver> solver;
};

DirectSolver::DirectSolver(const Library library, const std::optional<double> memory)
  : library_(library), memory_(memory)
{
}

void DirectSolver::factorise(const Sheet::Matrix &K)
{
  communicator_ = K.get_mpi_communicator();
  n_own_ = K.trilinos_matrix().NumMyRows();
  MatrixRows rows = gather_rows(K.trilinos_matrix(), communicator_);
  run_collectively(communicator_,
                   [&]
                   {
                     if (rows.lengths.empty())
                       return;
                     // After a failure there are no factors.
                     std::unique_ptr<Factors> factors = std::move(factors_);
                     if (factors && factors->has_sparsity_of(rows))
                       factors->replace_values(rows);
                     else
                       factors = std::make_unique<Factors>(std::move(rows), library_, memory_);
                     require_success(factors->solver->NumericFactorization(), "factorisation");
                     factors_ = std::move(factors);
                   });
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::solve(double *x, const double *b)
{
  const auto parts = dealii::Utilities::MPI::gather(communicator_, std::vector<double>(b, b + n_own_));
  run_collectively(communicator_,
                   [&]
                   {
                     if (!factors_)
                       return;
                     double *to = factors_->b.Values();
                     for (const std::vector<double> &part : parts)
                       to = std::copy(part.begin(), part.end(), to);
                     require_success(factors_->solver->Solve(), "forward and backward substitution");
                   });
  std::vector<int> counts;
  std::vector<int> offsets;
  for (const std::vector<double> &part : parts)
  {
    offsets.push_back(counts.empty() ? 0 : offsets.back() + counts.back());
    counts.push_back(static_cast<int>(part.size()));
  }
  MPI_Scatterv(factors_ ? factors_->x.Values() : nullptr, counts.data(), offsets.data(), MPI_DOUBLE, x,
               static_cast<int>(n_own_), MPI_DOUBLE, 0, communicator_);
}

void DirectSolver::solve(Sheet::Vector &x, const Sheet::Vector &b)
{
  solve(x.trilinos_vector()[0], b.trilinos_vector()[0]);
}

void DirectSolver::solve(LinearAlgebra::distributed::Vector<double> &x,
                         const LinearAlgebra::distributed::Vector<double> &b)
{
  solve(x.begin(), b.begin());
}
} // namespace latcon::continuum
