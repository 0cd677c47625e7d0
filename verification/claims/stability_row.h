#pragma once

#include <cmath>
#include <sstream>

#include "support/largest_error.h"
#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Row of a claim on the stability of the loaded lattice against waves of every length, which every comparison of the
/// loaded sheet assumes. The error is the distance of the smallest w^2 / k^2 below zero.
inline output::Result stability_row(const bridge::Subject &subject, const std::string &claim)
{
  std::ostringstream quantity;
  quantity << subject.name << ": stability of the loaded lattice, smallest w^2/k^2 of all waves over c_S^2 at F = I";
  if (!subject.is_stable())
  {
    const Eigen::Vector2d &K = subject.slowest_wave.wave_vector;
    quantity << "; it buckles in waves of kd = " << std::round(100. * K.norm() * subject.spacing) / 100. << " at "
             << std::lround(std::atan2(K.y(), K.x()) * 180. / M_PI) << " degrees";
  }
  const double smallest = subject.slowest_wave.squared_speed / std::pow(subject.theory.shear_speed, 2);
  // At zero the lattice is about to buckle, and counts as unstable.
  const double error = subject.is_stable() ? 0. : support::largest_of({-smallest, 1e-15});
  return {claim, quantity.str(), "1", smallest, {}, {}, error, {0., "a sign"}};
}

} // namespace latcon::claims
