#pragma once

#include <mpi.h>

#include <functional>
#include <string>

namespace latcon::continuum
{
/// Runs local work that may throw and defers its exception until all ranks can throw together. An exception thrown on
/// one rank only would leave the other ranks waiting in their next communication.
///
///   DeferredException guarded([&] { ...loop over own cells... });
///   vector.compress(add);                 // collective, so on every rank, whatever happened
///   guarded.rethrow_collectively(communicator);          // throws on every rank or on none
class DeferredException
{
public:
  /// Runs `work` immediately and stores its exception, if any. `work` must not communicate.
  explicit DeferredException(const std::function<void()> &work);

  /// Throws the same exception on every rank if the work failed on any rank, with the message of the lowest rank that
  /// has the most severe failure. Types that are preserved, most severe first: std::runtime_error (any type not listed
  /// here becomes one), OutputFailed, LinearSolverFailed, support::InputError, InvalidInput, NonPhysicalState.
  /// Collective.
  void rethrow_collectively(MPI_Comm communicator) const;

private:
  int kind_ = 0;
  std::string message_;
};

/// Runs local `work` and rethrows its exception on every rank: a DeferredException with nothing in between. Collective.
void run_collectively(MPI_Comm communicator, const std::function<void()> &work);
} // namespace latcon::continuum
