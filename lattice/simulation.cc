#include "lattice/simulation.h"

#include <stdexcept>

#include "lattice/runge_kutta_chebyshev.h"
#include "lattice/velocity_verlet.h"

namespace lattice
{
namespace
{

std::unique_ptr<Integrator> integrator(const TriangularLattice &lattice, Forces &forces, const TimeStepping &how)
{
  if (how.stages == 0)
    return std::make_unique<VelocityVerlet>(lattice, forces, how.step);
  return std::make_unique<RungeKuttaChebyshev>(lattice, forces, how.step, how.stages);
}

} // namespace

Simulation::Simulation(const TriangularLattice &lattice, const Material &material, State initial,
                       TimeStepping time_stepping, std::optional<Fracture> fracture)
  : lattice_(lattice), material_(material), state_(std::move(initial)), forces_(lattice, material),
    integrator_(integrator(lattice, forces_, time_stepping)), fracture_(std::move(fracture))
{
  if (fracture_)
    fracture_->watch(forces_);
  // Long steps would break bonds late; those of velocity Verlet are so short that they need not look ahead.
  if (fracture_ && time_stepping.stages > 0)
    fracture_->look_ahead(0.5 * time_stepping.step);
  initial_energy_ = elastic_energy(state_, lattice_, material_) + kinetic_energy(state_, lattice_);
  restart();
}

void Simulation::restart()
{
  if (contact_)
    contact_->find_candidates(state_);
  integrator_->initialise(state_);
  note_powers();
}

void Simulation::note_powers()
{
  contact_power_ = 0.;
  boundary_power_ = edges_move_ ? boundary_power(state_, lattice_, forces_) : 0.;
  if (contact_)
  {
    // A held site that moves pushes with what the contact pushes it.
    contact_power_ = -power(contact_->last(), state_, false) - power(contact_->last(), state_, true);
    boundary_power_ -= power(contact_->last(), state_, true);
  }
  if (end_loads_)
    boundary_power_ += power(end_loads_->last(), state_, false);
}

void Simulation::let_touch(const ContactLaw &law)
{
  contact_.emplace(lattice_, law);
  integrator_->add(*contact_);
  restart();
}

void Simulation::load_ends(const Eigen::Matrix2d &F, EndLoads::End left, EndLoads::End right)
{
  end_loads_.emplace(lattice_, material_, state_, F, left, right);
  integrator_->add(*end_loads_);
  restart();
}

void Simulation::cut(const std::vector<std::size_t> &places)
{
  if (!fracture_)
    throw std::logic_error("a sheet without fracture rules cannot be cut");
  for (const std::size_t place : places)
    broken_ += fracture_->remove_site(state_, place);
  fracture_->locate_tip(state_);
  restart();
}

void Simulation::move_edges(const Eigen::Matrix2d &velocity_gradient)
{
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (state_.held[place] != 0)
    {
      const Eigen::Vector2d velocity = velocity_gradient * lattice_.reference(place);
      state_.vx[place] = velocity.x();
      state_.vy[place] = velocity.y();
    }
  edges_move_ = true;
  restart();
}

void Simulation::set_velocities(const Field &vx, const Field &vy)
{
  const double before = kinetic_energy(state_, lattice_);
  for (std::size_t place = 0; place < lattice_.n_places(); ++place)
    if (state_.inverse_mass[place] > 0.)
    {
      state_.vx[place] = vx[place];
      state_.vy[place] = vy[place];
    }
  initial_energy_ += kinetic_energy(state_, lattice_) - before;
  restart();
}

const std::vector<BrokenBond> &Simulation::step()
{
  const double h = time_step();
  const double viscous_power_before = forces_.viscous_power();
  integrator_->step(state_);

  // Powers are taken before bonds break, so that each interval of the trapezoidal rule sees one set of bonds.
  viscous_ += 0.5 * h * (viscous_power_before + forces_.viscous_power());
  const double contact_power_before = contact_power_, boundary_power_before = boundary_power_;
  note_powers();
  contact_energy_ += 0.5 * h * (contact_power_before + contact_power_);
  boundary_work_ += 0.5 * h * (boundary_power_before + boundary_power_);
  if (!fracture_)
    return no_bonds_;

  const std::vector<BrokenBond> &broken =
    fracture_->apply(state_, forces_, integrator_->evaluated_vx(state_), integrator_->evaluated_vy(state_));
  if (!broken.empty())
  {
    for (const BrokenBond &bond : broken)
      broken_ += bond.energy;
    n_broken_ += broken.size();
    if (contact_)
    {
      // From this instant on, as the bonds are gone from it.
      contact_->note(state_, broken);
      contact_->evaluate(state_, integrator_->evaluated_vx(state_), integrator_->evaluated_vy(state_));
    }
    integrator_->update_accelerations(state_);
    note_powers();
  }
  return broken;
}

std::optional<std::size_t> Simulation::tip() const
{
  return fracture_ ? fracture_->tip() : std::nullopt;
}

EnergyBalance Simulation::energies() const
{
  return {elastic_energy(state_, lattice_, material_),
          kinetic_energy(state_, lattice_),
          viscous_,
          broken_,
          contact_energy_,
          boundary_work_,
          initial_energy_};
}

} // namespace lattice
