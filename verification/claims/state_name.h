#pragma once

#include <sstream>
#include <string>

#include <Eigen/Core>

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

} // namespace latcon::claims
