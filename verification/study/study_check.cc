#include "verification/study/study_check.h"

#include <algorithm>
#include <stdexcept>

#include "support/one_thread.h"
#include "verification/claims/steady_crack/steady_crack_study.h"

namespace latcon::study
{

const std::vector<StudyCheck> &study_checks()
{
  static const std::vector<StudyCheck> all{
    {"steady-crack",
     "The simulator against the exact solution of a steady crack between linear nearest-neighbour bonds with Kelvin "
     "dashpots at infinitesimal strain. In the same strip under the same load, a crack of the simulator must have the "
     "speed of the solution, and release and dissipate the same energy per broken bond. Tolerances are derived from "
     "runs "
     "with half the time step, half the strain and a longer strip.",
     claims::steady_crack_study}};
  return all;
}

CheckResult run_check(const std::string &name, const bool quick, const std::string &folder)
{
  const auto check = std::find_if(study_checks().begin(), study_checks().end(),
                                  [&name](const StudyCheck &known) { return known.name == name; });
  if (check == study_checks().end())
    throw std::logic_error("study: '" + name + "' is not a check");
  const support::OneThread one_thread;
  const claims::ClaimOutcome outcome = check->run(quick);
  outcome.write_tables(folder);
  return {check->name, check->about, outcome.results};
}

} // namespace latcon::study
