#include "continuum/collective.h"

#include "continuum/errors.h"
#include "support/errors.h"

#include <deal.II/base/mpi.h>

#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>

#include <utility>

namespace latcon::continuum
{
namespace
{
// Types of failures by severity, numbered from 1. Any other type counts as the last one.
template <class... Failures>
struct Severity
{
  static int of(const std::exception &failure)
  {
    int kind = 0;
    bool is_found = false;
    ((is_found = is_found || (++kind, dynamic_cast<const Failures *>(&failure) != nullptr)), ...);
    return kind;
  }

  static void rethrow(int kind, const std::string &message) { ((--kind == 0 ? throw Failures(message) : void()), ...); }
};
// A retry with a smaller step can recover from a non-physical state, but not from the others.
using Kinds =
  Severity<NonPhysicalState, InvalidInput, support::InputError, LinearSolverFailed, OutputFailed, std::runtime_error>;
} // namespace

DeferredException::DeferredException(const std::function<void()> &work)
{
  try
  {
    work();
  }
  catch (const std::exception &failure)
  {
    kind_ = Kinds::of(failure);
    // cppcheck-suppress useInitializationList ; the message is known only here
    message_ = failure.what();
  }
}

void DeferredException::rethrow_collectively(const MPI_Comm communicator) const
{
  const int gravest = dealii::Utilities::MPI::max(kind_, communicator);
  if (gravest == 0)
    return;
  for (const auto &[kind, message] : dealii::Utilities::MPI::all_gather(communicator, std::pair(kind_, message_)))
    if (kind == gravest)
      Kinds::rethrow(kind, message);
}

void run_collectively(const MPI_Comm communicator, const std::function<void()> &work)
{
  DeferredException(work).rethrow_collectively(communicator);
}
} // namespace latcon::continuum
