#include "verification/claims/claim_inputs.h"

#include <map>
#include <memory>

#include <omp.h>

#include "verification/bridge/subject.h"
#include "verification/claims/claim_list.h"

namespace latcon::claims
{

ClaimOutcome check_claim(const std::string &name, const ClaimInput &input)
{
  static const std::map<std::string, ClaimOutcome (*)(const ClaimInput &)> checks{
#define LATCON_CLAIM(name, ...) {claim_name(#name), check_##name},
#include "verification/claims/claim_table.inc"
#undef LATCON_CLAIM
  };
  return checks.at(name)(input);
}

ClaimOutcome run_claims(const input::Case &input, const std::vector<Claim> &claims, bool quick, Shells shells,
                        const bridge::Laws &laws, const std::string &frames)
{
  const std::shared_ptr<void> restored(nullptr, [n = omp_get_max_threads()](void *) { omp_set_num_threads(n); });
  if (quick)
    omp_set_num_threads(1); // synchronisation of such small lattices costs more than threads save, and changes no bit
  const input::Case read = claim_inputs(input);
  std::vector<bridge::Subject> subjects{bridge::subject(read, read.material(), laws)};
  if ((read.has_next_nearest || read.has_third_nearest) && shells == Shells::own_and_nearest)
  {
    lattice::Material nearest_only = read.material();
    nearest_only.next_nearest.reset();
    nearest_only.third_nearest.reset();
    subjects.push_back(bridge::subject(read, nearest_only, laws));
  }
  ClaimOutcome outcome;
  for (const Claim &claim : claims)
  {
    const input::Case entries = claim_inputs(input, claim.entries);
    ClaimOutcome found;
    for (const bridge::Subject &one : subjects)
      if (&one == &subjects.front() || (!claim.is_about_program && (!quick || !claim.quick_on_own_shells_only)))
        found.results.attempt(claim.name, one.name,
                              [&] {
                                found.add(check_claim(claim.name, {one, entries, quick, frames}));
                              });
    if (claim.gate)
      found.results.mark_gate();
    outcome.add(found);
  }
  return outcome;
}

} // namespace latcon::claims
