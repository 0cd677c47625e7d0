#include "verification/claims/claim_input.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/prestretch/cut_study.h"
#include "verification/claims/prestretch/prestretch_claim.h"

namespace latcon::claims
{

ClaimOutcome check_prestretch(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  const bool quick = input.quick;
  PrestretchOptions options;
  if (!quick)
  {
    options.length = 120.;
    options.height = 80.;
    options.cells_x = 24;
    options.cells_y = 16;
  }
  ClaimOutcome outcome{prestretch_claim(subject, options), {}};
  if (subject.material.coordination() == 6)
  {
    outcome.add(cut_claim(subject, nearest_hole_study(quick)));
    if (!quick)
      outcome.add(cut_claim(subject, notch_study(false)));
    return outcome;
  }
  outcome.add(cut_claim(subject, hole_study(quick)));
  outcome.add(cut_claim(subject, notch_study(quick)));
  if (!quick && subject.is_stable() && (subject.deformation - Eigen::Matrix2d::Identity()).norm() > 0.01)
    outcome.add(cut_claim(subject, loaded_hole_study(subject.deformation)));
  return outcome;
}

} // namespace latcon::claims
