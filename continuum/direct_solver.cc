#include "continuum/direct_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "support/machine_memory.h"

#include <Amesos.h>
#include <Amesos_Mumps.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
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

} // namespace

// Copy of the matrix on the root rank, since Amesos refers to it as long as the factors exist, and its factors.
struct DirectSolver::Factors
{
  explicit Factors(const Epetra_CrsMatrix &K)
    : own_rows(K.RowMap()), root_rows(-1, K.Comm().MyPID() == 0 ? K.NumGlobalRows() : 0, 0, K.Comm()),
      gather(root_rows, own_rows), alone(root_rows.NumMyElements(), 0, Epetra_MpiComm(MPI_COMM_SELF)),
      matrix(Copy, alone, alone, K.GlobalMaxNumEntries()), x(alone), b(alone), problem(&matrix, &x, &b)
  {
  }

  // Collective.
  void copy(const Epetra_CrsMatrix &K)
  {
    Epetra_CrsMatrix rows(Copy, root_rows, K.GlobalMaxNumEntries());
    rows.Import(K, gather, Insert);
    for (int row = 0; row < rows.NumMyRows(); ++row)
    {
      int n = 0;
      double *values = nullptr;
      int *columns = nullptr;
      rows.ExtractGlobalRowView(row, n, values, columns);
      if (solver)
        matrix.ReplaceMyValues(row, n, values, columns);
      else
        matrix.InsertMyValues(row, n, values, columns);
    }
  }

  // On the root rank.
  void factorise(const Library library, const std::optional<double> &memory)
  {
    if (!solver)
    {
      matrix.FillComplete();
      Amesos factory;
      const bool uses_mumps = library == Library::mumps && factory.Query("Amesos_Mumps");
      solver.reset(factory.Create(uses_mumps ? "Amesos_Mumps" : "Amesos_Klu", problem));
      require_success(solver->SymbolicFactorization(), "symbolic factorisation");
      require_memory(*solver, matrix.NumMyRows(), memory);
    }
    require_success(solver->NumericFactorization(), "factorisation");
  }

  Epetra_Map own_rows;
  Epetra_Map root_rows; // all on the root rank
  Epetra_Import gather;
  Epetra_Map alone; // as root_rows, without the other ranks
  Epetra_CrsMatrix matrix;
  Epetra_Vector x;
  Epetra_Vector b;
  Epetra_LinearProblem problem;
  std::unique_ptr<Amesos_BaseSolver> solver; // on the root rank
};

DirectSolver::DirectSolver(const Library library, const std::optional<double> memory)
  : library_(library), memory_(memory)
{
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::factorise(const Sheet::Matrix &K)
{
  // After a failure there are no factors.
  std::unique_ptr<Factors> factors = std::move(factors_);
  if (!factors)
    factors = std::make_unique<Factors>(K.trilinos_matrix());
  factors->copy(K.trilinos_matrix());
  communicator_ = K.get_mpi_communicator();
  run_collectively(communicator_,
                   [&]
                   {
                     if (factors->root_rows.NumMyElements() > 0)
                       factors->factorise(library_, memory_);
                   });
  factors_ = std::move(factors);
}

void DirectSolver::solve(double *x, const double *b)
{
  Factors &factors = *factors_;
  const Epetra_Vector own_b(View, factors.own_rows, const_cast<double *>(b));
  Epetra_Vector(View, factors.root_rows, factors.b.Values()).Import(own_b, factors.gather, Insert);
  run_collectively(communicator_,
                   [&]
                   {
                     if (factors.solver)
                       require_success(factors.solver->Solve(), "forward and backward substitution");
                   });
  const Epetra_Vector root_x(View, factors.root_rows, factors.x.Values());
  Epetra_Vector(View, factors.own_rows, x).Export(root_x, factors.gather, Insert);
}
} // namespace latcon::continuum
