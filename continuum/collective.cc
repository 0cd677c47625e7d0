#include "continuum/collective.h"

#include "continuum/errors.h"

#include <exception>

namespace latcon::continuum
{
namespace
{
// In order of severity: a retry with a smaller step can recover from a non-physical state, but not from the others.
enum FailureKind : int
{
  none,
  non_physical_state,
  invalid_input,
  linear_solver_failed,
  output_failed,
  other
};

[[noreturn]] void rethrow(const int kind, const std::string &message)
{
  switch (kind)
  {
  case non_physical_state:
    throw NonPhysicalState(message);
  case invalid_input:
    throw InvalidInput(message);
  case linear_solver_failed:
    throw LinearSolverFailed(message);
  case output_failed:
    throw OutputFailed(message);
  default:
    throw std::runtime_error(message);
  }
}
} // namespace

DeferredException::DeferredException(const std::function<void()> &work)
{
  const auto keep = [this](const int kind, const std::exception &failure)
  {
    kind_ = kind;
    // cppcheck-suppress useInitializationList ; the message is known only here
    message_ = failure.what();
  };
  try
  {
    work();
  }
  catch (const NonPhysicalState &failure)
  {
    keep(non_physical_state, failure);
  }
  catch (const InvalidInput &failure)
  {
    keep(invalid_input, failure);
  }
  catch (const LinearSolverFailed &failure)
  {
    keep(linear_solver_failed, failure);
  }
  catch (const OutputFailed &failure)
  {
    keep(output_failed, failure);
  }
  catch (const std::exception &failure)
  {
    keep(other, failure);
  }
}

void DeferredException::rethrow_collectively(const MPI_Comm communicator) const
{
  int gravest = none;
  MPI_Allreduce(&kind_, &gravest, 1, MPI_INT, MPI_MAX, communicator);
  if (gravest == none)
    return;

  int rank = 0;
  int n_ranks = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &n_ranks);
  const int candidate = kind_ == gravest ? rank : n_ranks;
  int speaker = 0;
  MPI_Allreduce(&candidate, &speaker, 1, MPI_INT, MPI_MIN, communicator);

  std::string message = message_;
  unsigned long length = message.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, speaker, communicator);
  message.resize(length);
  MPI_Bcast(message.data(), static_cast<int>(length), MPI_CHAR, speaker, communicator);
  rethrow(gravest, message);
}

void run_collectively(const MPI_Comm communicator, const std::function<void()> &work)
{
  DeferredException(work).rethrow_collectively(communicator);
}
} // namespace latcon::continuum
