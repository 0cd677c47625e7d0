/// Homogeneous states about which claims evaluate waves.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "support/largest_error.h"
#include "verification/bridge/subject.h"
#include "verification/output/results.h"

namespace latcon::claims
{

/// Names of the waves of a direction, as Bloch matrices and Christoffel tensors order them: quasi-longitudinal,
/// quasi-shear.
inline constexpr const char *wave_names[] = {"L", "S"};

/// Name of a homogeneous state in rows and plots: "F = I", "F = (2.3, 2.8)", "F = (1, 1, shear 0.5)".
inline std::string state_name(const Eigen::Matrix2d &F)
{
  if (F.isIdentity(1e-12))
    return "F = I";
  std::ostringstream text;
  text << "F = (" << F(0, 0) << ", " << F(1, 1);
  if (F(0, 1) != 0.)
    text << ", shear " << F(0, 1);
  text << ")";
  return text.str();
}

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

/// Returns by how much the first order that the gradient continuum leaves out, (k l)^4 / 480 of the speed for a bond of
/// length l along the wave [-], is larger than with bonds of sqrt(3) d at most: (2 / sqrt(3))^4 with third-nearest
/// neighbours, otherwise 1. A factor of tolerances at a wave number k.
inline double gradient_remainder(const bridge::Subject &subject)
{
  return subject.material.third_nearest ? 16. / 9. : 1.;
}

} // namespace latcon::claims
