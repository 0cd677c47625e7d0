#pragma once

#include "verification/bridge/subject.h"

namespace latcon::claims
{
/// Returns by how much the first order that the gradient continuum leaves out, (k l)^4 / 480 of the speed for a bond of
/// length l along the wave [-], is larger than with bonds of sqrt(3) d at most: (2 / sqrt(3))^4 with third-nearest
/// neighbours, otherwise 1. A factor of tolerances at a wave number k.
inline double gradient_remainder(const bridge::Subject &subject)
{
  return subject.material.third_nearest ? 16. / 9. : 1.;
}
} // namespace latcon::claims
