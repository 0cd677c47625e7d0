#pragma once

#include <vector>

#include "lattice/state.h"

namespace lattice
{

/// A force on one site, per sheet thickness.
struct SiteForce
{
  std::size_t place;
  Eigen::Vector2d force; ///< [N/m]
};

/// Forces on a few sites that no bond exerts: contacts, loads on edges. An Integrator adds them to those of the bonds.
class SiteForces
{
public:
  virtual ~SiteForces() = default;

  /// The forces at positions state.x, y and the given velocities [m/s], in an order that depends on the state alone. A
  /// site may occur more than once.
  virtual const std::vector<SiteForce> &evaluate(const State &state, const Field &vx, const Field &vy) = 0;

  /// Those of the last evaluation.
  const std::vector<SiteForce> &last() const { return forces_; }

protected:
  std::vector<SiteForce> forces_;
};

/// Power sum f . v [W/m] that forces put into sites moving with state.vx, vy: into those that move freely, or into the
/// held ones.
double power(const std::vector<SiteForce> &forces, const State &state, bool into_held);

} // namespace lattice
