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

  /// Computes the forces at the positions of the state and these velocities [m/s], in an order that depends on the
  /// state alone, whose own velocities, accelerations and history may be changing. A site may occur more than once.
  /// Collective: positions and velocities of sites in rows that this rank does not know are received where forces
  /// depend on them.
  virtual const std::vector<SiteForce> &evaluate(State &state, VectorField &velocity) = 0;

  /// Forces of the last evaluation.
  const std::vector<SiteForce> &last() const { return forces_; }

protected:
  std::vector<SiteForce> forces_;
};

} // namespace latcon::lattice
