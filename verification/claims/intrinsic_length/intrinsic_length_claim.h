#pragma once

#include "verification/bridge/subject.h"
#include "verification/claims/claim_outcome.h"

namespace latcon::claims
{

/// Claim `intrinsic-length`: effects of the length of the bonds, in dynamics and in statics.
///
/// Dynamics: waves soften as they shorten, by alpha (theory-comparison.md, eq. (W.2)), in every direction, with nearest
/// neighbours alone as well; the gradient continuum has the same alpha and is stable for its l_d. Statics: a free edge
/// has a layer of alternating row spacings with next-nearest neighbours, and none without.
///
/// Writes the tables `dispersion`, `dispersion_runs` and `edge_layer`. Every rank computes all of it.
struct IntrinsicLengthOptions
{
  double angle_step = 3.;     ///< [degrees] between directions in which alpha is evaluated
  double edge_stretch = 1.05; ///< along the edge whose layer is measured [-]
  std::size_t edge_rows = 12; ///< row spacings measured from the edge
};

/// Checks the claim. Collective.
ClaimOutcome intrinsic_length_claim(const bridge::Subject &subject, const IntrinsicLengthOptions &options);

} // namespace latcon::claims
