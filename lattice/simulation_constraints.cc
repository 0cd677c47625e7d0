#include <stdexcept>

#include "lattice/simulation.h"

namespace latcon::lattice
{

std::size_t Simulation::constrain(const Constraint &constraint)
{
  const PrescribedMotion added(band_, constraint);
  for (const PrescribedMotion &other : constraints_)
    if (added.overlaps(other))
      throw std::logic_error("a site is constrained twice along the same axis");
  const double before = kinetic_energy(state_, band_);
  lattice::constrain(state_, band_, constraint);
  initial_energy_ += kinetic_energy(state_, band_) - before;
  constraints_.push_back(added);
  for (Ledger *ledger : {&powers_, &work_})
    ledger->constraints.emplace_back(lattice_.rows(), 0.);
  update_rollers();
  reinitialize_forces();
  return constraints_.size() - 1;
}

void Simulation::set_motion(std::size_t constraint, Constraint::Motion motion)
{
  constraints_.at(constraint).set_motion(std::move(motion));
}

// Velocities of constrained sites for the next `duration` [s]. Forces are evaluated anew only where they change.
void Simulation::prescribe_motion(double duration)
{
  bool changed = false;
  for (std::size_t c = 0; c < constraints_.size(); ++c)
  {
    if (constraints_[c].ends(state_.time))
    {
      constraints_[c].release(state_, material_, work_.constraints[c]);
      changed = true;
    }
    changed = constraints_[c].prescribe(state_, state_.time, state_.time + duration) || changed;
  }
  if (!changed)
    return;
  update_rollers();
  reinitialize_forces();
}

void Simulation::update_rollers()
{
  std::vector<RollerVelocity> rollers;
  for (const PrescribedMotion &constraint : constraints_)
    constraint.append_rollers(state_, rollers);
  integrator_->set_rollers(std::move(rollers));
}

} // namespace latcon::lattice
