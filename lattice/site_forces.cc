#include "lattice/site_forces.h"

namespace lattice
{

double power(const std::vector<SiteForce> &forces, const State &state, bool into_held)
{
  double sum = 0.;
  for (const auto &[place, force] : forces)
    if ((state.held[place] != 0) == into_held)
      sum += force.dot(Eigen::Vector2d(state.vx[place], state.vy[place]));
  return sum;
}

} // namespace lattice
