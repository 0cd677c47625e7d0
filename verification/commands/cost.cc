#include "verification/commands/cost.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <omp.h>

#include "support/errors.h"
#include "support/ranks.h"

namespace latcon::commands
{
namespace
{

constexpr const char *confirmation = "; use --yes to run it anyway";

} // namespace

void require_memory(const input::Options &options, const resources::MemoryNeed &need)
{
  if (options.yes)
    return;
  try
  {
    resources::require_memory(need);
  }
  catch (const support::InputError &error)
  {
    throw support::InputError(std::string(error.what()) + confirmation);
  }
}

void require_time(const input::Options &options, const double seconds)
{
  if (options.yes || !(seconds > longest_run))
    return;
  std::ostringstream text;
  text.precision(2);
  text << "the run would take about " << seconds / 86400. << " days, more than " << longest_run / 86400.
       << "; make the sheet smaller or coarser, the motion shorter, or use more cores" << confirmation;
  throw support::InputError(text.str());
}

double rough_seconds(const input::Case &input, const lattice::TimeStepping &stepping, const double steps)
{
  const double ranks = support::n_ranks();
  return resources::core_seconds(input, steps * stepping.evaluations()) / (ranks * omp_get_max_threads());
}

} // namespace latcon::commands
