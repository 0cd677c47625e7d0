#pragma once

#include <cmath>
#include <optional>

#include <Eigen/Core>

namespace latcon::lattice
{

/// The tip of a crack: the right-most of the sites that are considered, so that it never retreats. Among sites at the
/// same X it is the one nearest the tip before the step, then the one considered first.
struct CrackTip
{
  std::optional<std::size_t> place; ///< none before a site was considered
  Eigen::Vector2d X{0., 0.};        ///< its reference position [m]
  double Y_before = 0.;             ///< reference Y of the tip before this step [m]

  void begin_step()
  {
    if (place)
      Y_before = X.y();
  }
  void consider(std::size_t site, const Eigen::Vector2d &at)
  {
    if (place && (at.x() < X.x() || (at.x() == X.x() && !(std::abs(at.y() - Y_before) < std::abs(X.y() - Y_before)))))
      return;
    place = site;
    X = at;
  }
};

} // namespace latcon::lattice
