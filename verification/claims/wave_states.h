/// States of deformation in which several claims evaluate waves.
#pragma once

#include <vector>

#include "verification/bridge/subject.h"

namespace latcon::claims
{

/// Deformation gradients about which waves are evaluated: undeformed; in the full version stretched equally along both
/// axes; and as the case is loaded, unless the loaded lattice buckles and has no waves.
inline std::vector<Eigen::Matrix2d> wave_states(const bridge::Subject &subject, bool quick)
{
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  std::vector<Eigen::Matrix2d> list{I};
  if (!quick && !subject.deformation.isApprox(I, 1e-12))
    list.emplace_back(1.5 * I);
  if (subject.is_stable() && !subject.deformation.isApprox(I, 1e-12))
    list.push_back(subject.deformation);
  return list;
}

} // namespace latcon::claims
