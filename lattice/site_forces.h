#pragma once

#include <vector>

#include "lattice/state.h"

namespace latcon::lattice
{

/// A force on one site, per sheet thickness.
struct SiteForce
{
  std::size_t place;
  Eigen::Vector2d force; ///< [N/m]
};

/// Forces on a few sites of a band of rows that no bond exerts: contacts, loads on edges. An Integrator adds them to
/// those of the bonds.
class SiteForces
{
public:
  virtual ~SiteForces() = default;

  /// The forces at positions state.x, y and the given velocities [m/s], in an order that depends on the state alone. A
  /// site may occur more than once.
  virtual const std::vector<SiteForce> &evaluate(const State &state, const Field &vx, const Field &vy) = 0;

  /// Sites whose positions and velocities the forces depend on, wherever in the sheet they are: the same list on all
  /// ranks. Whoever calls evaluate() sees to it that they are known.
  virtual const std::vector<std::size_t> &required_sites() const
  {
    static const std::vector<std::size_t> none;
    return none;
  }

  /// Forces of the last evaluation.
  const std::vector<SiteForce> &last() const { return forces_; }

protected:
  std::vector<SiteForce> forces_;
};

} // namespace latcon::lattice
