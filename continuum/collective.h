#pragma once

#include <mpi.h>

#include <functional>
#include <string>

namespace latcon::continuum
{
/// Work of one rank that may throw, kept from throwing until all ranks have agreed on it: an exception that left one
/// rank alone would leave the others waiting in their next communication.
///
///   DeferredException guarded([&] { ...loop over own cells... });
///   vector.compress(add);                 // collective, so on every rank, whatever happened
///   guarded.rethrow_collectively(communicator);          // throws on every rank or on none
class DeferredException
{
public:
  /// Runs `work` at once and keeps what it throws. `work` must not communicate.
  explicit DeferredException(const std::function<void()> &work);

  /// Collective. If the work failed on any rank, every rank throws the same exception, with the message of the lowest
  /// rank among those with the gravest failure. Types kept, gravest first: std::runtime_error (which stands for every
  /// type not named here), OutputFailed, LinearSolverFailed, InvalidInput, NonPhysicalState.
  void rethrow_collectively(MPI_Comm communicator) const;

private:
  int kind_ = 0;
  std::string message_;
};

/// DeferredException and its agreement in one: for work that needs no communication before the agreement.
void collectively(MPI_Comm communicator, const std::function<void()> &work);
} // namespace latcon::continuum
