#include "continuum/damage/damage_motion.h"

#include "continuum/damage/patch_bound.h"
#include "continuum/errors.h"

#include <cmath>
#include <string>

using dealii::Point;
using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
std::vector<char> intact_nodes(const NodeGrid &grid, const DamageMotionSetup &setup)
{
  std::vector<char> intact(grid.n_nodes(), 0);
  if (setup.is_intact)
    for (std::size_t a = 0; a < intact.size(); ++a)
      intact[a] = setup.is_intact(grid.position(a)) ? 1 : 0;
  return intact;
}

GridVector zero_vector(const NodeGrid &grid)
{
  return {std::vector<double>(grid.n_nodes(), 0.), std::vector<double>(grid.n_nodes(), 0.)};
}

std::array<std::vector<char>, 2> held_nodes(const NodeGrid &grid, const DamageMotionSetup &setup)
{
  if (!setup.is_held)
    throw InvalidInput("a sheet in motion needs to know its held nodes");
  std::array<std::vector<char>, 2> held;
  for (const unsigned int i : {0u, 1u})
    for (std::size_t a = 0; a < grid.n_nodes(); ++a)
      held[i].push_back(setup.is_held(grid.position(a), i) ? 1 : 0);
  return held;
}

double inertia_length(const DamageMotionSetup &setup)
{
  return setup.gradient && setup.gradient->has_micro_inertia ? setup.gradient->length : 0.;
}

// State of the equations of motion, or its rate.
struct PhasePoint
{
  GridVector u, v;
  double dissipated = 0.; // [J/m]
};
} // namespace

DamageMotion::DamageMotion(const DamageMotionSetup &setup)
  : setup_(setup),
    forces_(NodeGrid(setup.rectangle), setup.families, setup.dashpots, setup.loading, setup.communicator),
    damage_(forces_.grid(), setup.damage, intact_nodes(forces_.grid(), setup)), held_(held_nodes(grid(), setup)),
    mass_(grid(), setup.density, inertia_length(setup), held_, setup.communicator), u_(zero_vector(grid())),
    v_(zero_vector(grid()))
{
  const auto require = [](const bool holds, const char *rule)
  {
    if (!holds)
      throw InvalidInput(rule);
  };
  require(setup.density > 0. && std::isfinite(setup.density), "the density must be positive and finite");
  require(setup.step > 0. && std::isfinite(setup.step), "the time step must be positive and finite");
  if (setup.gradient)
  {
    require(setup.gradient->length > 0. && std::isfinite(setup.gradient->length),
            "the intrinsic length must be positive and finite");
    gradient_.emplace(grid(), setup.gradient->bonds, setup.gradient->length, setup.loading, setup.communicator);
  }
  if (const double rate = viscous_rate(); rate > 0.)
    stages_.emplace(ViscousStages::required(setup.step * rate, 2. * setup.step / stable_step()));
  else
    require(setup.step < stable_step(), "the time step exceeds the stability limit of a sheet without viscosity");
  restart_ledger();
}

double DamageMotion::viscous_rate() const
{
  if (!gradient_)
    return forces_.viscous_rate(setup_.density);
  return patch_bound(grid(), forces_.viscous_conductivity(), {}, setup_.density, inertia_length(setup_));
}

double DamageMotion::stable_step() const
{
  if (!gradient_)
    return 2. / forces_.elastic_frequency(setup_.density);
  return 2. / std::sqrt(patch_bound(grid(), forces_.elastic_conductivity(),
                                    gradient_->patch_terms(FibreForces::relaxed_stretch), setup_.density,
                                    inertia_length(setup_)));
}

void DamageMotion::set_motion(const std::function<Tensor<1, 2>(const Point<2> &)> &displacement,
                              const std::function<Tensor<1, 2>(const Point<2> &)> &velocity)
{
  for (std::size_t a = 0; a < grid().n_nodes(); ++a)
  {
    const Tensor<1, 2> u = displacement(grid().position(a)), v = velocity(grid().position(a));
    for (const unsigned int i : {0u, 1u})
      if (!held_[i][a])
      {
        u_[i][a] = u[i];
        v_[i][a] = v[i];
      }
  }
  restart_ledger();
}

void DamageMotion::set_damage(const std::function<double(const Point<2> &)> &damage)
{
  std::vector<double> nodal;
  for (std::size_t a = 0; a < grid().n_nodes(); ++a)
    nodal.push_back(damage(grid().position(a)));
  damage_.set(nodal);
  update_masses();
  restart_ledger();
}

void DamageMotion::settle_damage()
{
  if (damage_.minimize(cell_energies_, node_energies_))
    update_masses();
  restart_ledger();
}

void DamageMotion::restart_ledger()
{
  compute_energies();
  ledger_ = {};
  initial_fracture_ = damage_.fracture_energy();
  initial_energy_ = 0.;
  update_energies();
  initial_energy_ = ledger_.elastic + ledger_.kinetic + ledger_.gradient;
  update_energies();
}

void DamageMotion::compute_energies()
{
  forces_.energies(u_, damage_.cell_factors(), cell_energies_);
  if (gradient_)
    gradient_->energies(u_, node_energies_);
}

void DamageMotion::update_energies()
{
  ledger_.elastic = 0.;
  for (std::size_t c = 0; c < cell_energies_.size(); ++c)
    ledger_.elastic += damage_.cell_factors()[c] * cell_energies_[c];
  ledger_.gradient = 0.;
  for (std::size_t a = 0; a < node_energies_.size(); ++a)
    ledger_.gradient += damage_.node_factors()[a] * node_energies_[a];
  ledger_.kinetic = mass_.kinetic_energy(v_);
  ledger_.fracture = damage_.fracture_energy() - initial_fracture_;
  ledger_.imbalance = initial_energy_ - ledger_.elastic - ledger_.kinetic - ledger_.viscous - ledger_.fracture -
                      ledger_.shed - ledger_.gradient;
  if (!std::isfinite(ledger_.imbalance))
    throw NonPhysicalState("the energy of the sheet is not finite at time " + std::to_string(time()) + " s");
}

void DamageMotion::accelerate(const GridVector &u, const GridVector &v, GridVector &acceleration, double &power) const
{
  power = forces_.forces(u, v, damage_.cell_factors(), acceleration);
  if (gradient_)
    gradient_->add_forces(u, damage_.node_factors(), acceleration);
  mass_.solve(acceleration);
}

// Eq. (C.73). The dissipated energy is one more unknown of the method, with the power as its rate: quadrature between
// steps alone would miss the fast relaxation after damage.
void DamageMotion::advance_viscous()
{
  const double h = setup_.step;
  const PhasePoint initial{u_, v_, ledger_.viscous};
  PhasePoint before = initial, last = initial, rate, initial_rate;
  initial_rate.u = initial.v;
  accelerate(initial.u, initial.v, initial_rate.v, initial_rate.dissipated);
  const auto combine = [&](const ViscousStages::Stage &c, std::vector<double> &to, const std::vector<double> &Y0,
                           const std::vector<double> &Y1, const std::vector<double> &F0, const std::vector<double> &F1)
  {
#pragma omp parallel for simd schedule(static) if (parallel : grid().n_cells() >= FibreForces::min_cells_for_threads)
    for (std::size_t a = 0; a < to.size(); ++a)
      to[a] = (1. - c.mu - c.nu) * Y0[a] + c.mu * Y1[a] + c.nu * to[a] + h * (c.now * F1[a] + c.start * F0[a]);
  };
  const auto advance = [&](const ViscousStages::Stage &c, const PhasePoint &F1)
  {
    // Overwrites Y_{j-2} by Y_j.
    for (const unsigned int i : {0u, 1u})
    {
      combine(c, before.u[i], initial.u[i], last.u[i], initial_rate.u[i], F1.u[i]);
      combine(c, before.v[i], initial.v[i], last.v[i], initial_rate.v[i], F1.v[i]);
    }
    before.dissipated = (1. - c.mu - c.nu) * initial.dissipated + c.mu * last.dissipated + c.nu * before.dissipated +
                        h * (c.now * F1.dissipated + c.start * initial_rate.dissipated);
    std::swap(before, last);
  };
  advance({0., 0., stages_->first(), 0.}, initial_rate); // Y_1
  for (const ViscousStages::Stage &stage : stages_->stages())
  {
    rate.u = last.v;
    accelerate(last.u, last.v, rate.v, rate.dissipated);
    advance(stage, rate);
  }
  u_ = std::move(last.u);
  v_ = std::move(last.v);
  ledger_.viscous = last.dissipated;
}

void DamageMotion::advance_elastic()
{
  GridVector acceleration;
  double power = 0.;
  const auto add = [&](GridVector &to, const double factor, const GridVector &from)
  {
    for (const unsigned int i : {0u, 1u})
      for (std::size_t a = 0; a < to[i].size(); ++a)
        to[i][a] += factor * from[i][a];
  };
  accelerate(u_, v_, acceleration, power);
  add(v_, 0.5 * setup_.step, acceleration);
  add(u_, setup_.step, v_);
  accelerate(u_, v_, acceleration, power);
  add(v_, 0.5 * setup_.step, acceleration);
}

void DamageMotion::advance()
{
  const GridVector u = u_, v = v_;
  const std::vector<double> damage = damage_.nodal();
  const DamageMotionLedger ledger = ledger_;
  const std::size_t n_steps = n_steps_;
  try
  {
    step();
  }
  catch (...)
  {
    u_ = u;
    v_ = v;
    ledger_ = ledger;
    n_steps_ = n_steps;
    resume(damage);
    throw;
  }
}

void DamageMotion::step()
{
  if (stages_)
    advance_viscous();
  else
    advance_elastic();
  ++n_steps_;
  compute_energies();
  const double kinetic = mass_.kinetic_energy(v_);
  if (damage_.minimize(cell_energies_, node_energies_))
  {
    update_masses();
    ledger_.shed += kinetic - mass_.kinetic_energy(v_);
  }
  update_energies();
}
} // namespace latcon::continuum
