#include "lattice/integrator.h"

#include <stdexcept>

#include "lattice/rows.h"

namespace lattice
{
namespace
{

// Calls visit(place, acceleration) for every site force.
template <class Visitor>
void for_each_acceleration(const State &state, const std::vector<SiteForces *> &site_forces, const Visitor &visit)
{
  for (const SiteForces *forces : site_forces)
    for (const auto &[place, force] : forces->last())
      visit(place, Eigen::Vector2d(state.inverse_mass[place] * force));
}

} // namespace

Integrator::Integrator(const TriangularLattice &lattice, Forces &forces, double time_step)
  : lattice_(lattice), forces_(forces), time_step_(time_step)
{
  if (!(time_step > 0.))
    throw std::invalid_argument("time stepping needs a positive time step");
}

void Integrator::evaluate(State &state, const Field &vx, const Field &vy)
{
  forces_.evaluate(state, vx, vy);
  for (SiteForces *forces : site_forces_)
    forces->evaluate(state, vx, vy);
}

void Integrator::accelerate_sites(State &state) const
{
  for_each_acceleration(state, site_forces_,
                        [&](std::size_t place, const Eigen::Vector2d &acceleration)
                        {
                          state.ax[place] += acceleration.x();
                          state.ay[place] += acceleration.y();
                        });
}

void Integrator::kick_sites(State &state, double duration) const
{
  for_each_acceleration(state, site_forces_,
                        [&](std::size_t place, const Eigen::Vector2d &acceleration)
                        {
                          state.vx[place] += duration * acceleration.x();
                          state.vy[place] += duration * acceleration.y();
                        });
}

void Integrator::update_accelerations(State &state) const
{
  for_each_row(lattice_,
               [&](std::size_t begin, std::size_t end)
               {
                 for (std::size_t i = begin; i < end; ++i)
                 {
                   state.ax[i] = forces_.fx()[i] * state.inverse_mass[i];
                   state.ay[i] = forces_.fy()[i] * state.inverse_mass[i];
                 }
               });
  accelerate_sites(state);
}

} // namespace lattice
