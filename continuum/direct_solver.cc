#include "continuum/direct_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <Amesos.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

#include <algorithm>
#include <vector>

using namespace dealii;

namespace continuum
{
struct DirectSolver::Factors
{
  std::unique_ptr<Epetra_CrsMatrix> gathered; // none on a rank that is alone
  std::unique_ptr<Epetra_Vector> x;
  std::unique_ptr<Epetra_Vector> b;
  Epetra_LinearProblem problem;
  std::unique_ptr<Amesos_BaseSolver> solver;
};

namespace
{
void require_success(const int code, const char *what)
{
  if (code != 0)
    throw LinearSolverFailed(std::string("the linear solver failed: ") + what + " with code " + std::to_string(code));
}

// Rows of a matrix that follow each other.
struct Rows
{
  std::vector<int> lengths;
  std::vector<int> columns;
  std::vector<double> values;
};

Rows own_rows(const Epetra_CrsMatrix &matrix)
{
  Rows rows;
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

// Of all ranks, on the first.
std::unique_ptr<Epetra_CrsMatrix> gather(const Epetra_CrsMatrix &matrix, const MPI_Comm communicator)
{
  const Rows own = own_rows(matrix);
  auto lengths = Utilities::MPI::gather(communicator, own.lengths);
  const auto columns = Utilities::MPI::gather(communicator, own.columns);
  const auto values = Utilities::MPI::gather(communicator, own.values);
  std::vector<int> all_lengths;
  for (const std::vector<int> &of_rank : lengths)
    all_lengths.insert(all_lengths.end(), of_rank.begin(), of_rank.end());
  if (all_lengths.empty())
    return nullptr;
  const Epetra_Map map(static_cast<int>(all_lengths.size()), 0, Epetra_MpiComm(MPI_COMM_SELF));
  auto whole = std::make_unique<Epetra_CrsMatrix>(Copy, map, map, all_lengths.data(), true);
  int row = 0;
  for (std::size_t rank = 0; rank < lengths.size(); ++rank)
  {
    std::size_t at = 0;
    for (const int n : lengths[rank])
    {
      whole->InsertMyValues(row++, n, values[rank].data() + at, columns[rank].data() + at);
      at += n;
    }
  }
  whole->FillComplete();
  return whole;
}
} // namespace

DirectSolver::DirectSolver(const Sheet::Matrix &K, const Library library)
  : communicator_(K.get_mpi_communicator()), n_own_(K.trilinos_matrix().NumMyRows())
{
  std::unique_ptr<Epetra_CrsMatrix> gathered;
  const bool is_alone = Utilities::MPI::n_mpi_processes(communicator_) == 1;
  if (!is_alone)
    gathered = gather(K.trilinos_matrix(), communicator_);
  collectively(communicator_,
               [&]
               {
                 if (!is_alone && !gathered)
                   return;
                 factors_ = std::make_unique<Factors>();
                 factors_->gathered = std::move(gathered);
                 Epetra_CrsMatrix &matrix =
                   is_alone ? const_cast<Epetra_CrsMatrix &>(K.trilinos_matrix()) : *factors_->gathered;
                 factors_->x = std::make_unique<Epetra_Vector>(matrix.DomainMap());
                 factors_->b = std::make_unique<Epetra_Vector>(matrix.RangeMap());
                 factors_->problem.SetOperator(&matrix);
                 factors_->problem.SetLHS(factors_->x.get());
                 factors_->problem.SetRHS(factors_->b.get());
                 Amesos factory;
                 const bool takes_mumps = library == Library::mumps && factory.Query("Amesos_Mumps");
                 factors_->solver.reset(factory.Create(takes_mumps ? "Amesos_Mumps" : "Amesos_Klu", factors_->problem));
                 require_success(factors_->solver->SymbolicFactorization(), "symbolic factorisation");
                 require_success(factors_->solver->NumericFactorization(), "factorisation");
               });
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::solve(double *x, const double *b)
{
  const auto parts = Utilities::MPI::gather(communicator_, std::vector<double>(b, b + n_own_));
  collectively(communicator_,
               [&]
               {
                 if (!factors_)
                   return;
                 double *to = factors_->b->Values();
                 for (const std::vector<double> &part : parts)
                   to = std::copy(part.begin(), part.end(), to);
                 require_success(factors_->solver->Solve(), "solution by the factors");
               });
  std::vector<int> counts;
  std::vector<int> places;
  for (const std::vector<double> &part : parts)
  {
    places.push_back(counts.empty() ? 0 : places.back() + counts.back());
    counts.push_back(static_cast<int>(part.size()));
  }
  MPI_Scatterv(factors_ ? factors_->x->Values() : nullptr, counts.data(), places.data(), MPI_DOUBLE, x,
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
} // namespace continuum
