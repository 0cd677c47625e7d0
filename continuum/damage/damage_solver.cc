#include "continuum/damage/damage_solver.h"

#include "continuum/errors.h"

#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
Constitution with_damage(const Constitution &laws, const DamageField &field)
{
  if (laws.factor)
    throw InvalidInput("a sheet with damage must not have another stiffness factor");
  Constitution damaged = laws;
  damaged.factor = &field;
  return damaged;
}
} // namespace

DamageSolver::DamageSolver(const Sheet::Mesh &mesh, const Constitution &constitution,
                           const BoundaryConditions &conditions, const DamageLaw &law,
                           const std::set<types::boundary_id> &intact, const DamageSettings &settings)
  : settings_(settings), field_(mesh, law, intact, conditions.periodic),
    statics_(mesh, with_damage(constitution, field_), conditions, settings.statics),
    forces_(statics_.sheet().make_owned())
{
  if (!(settings.tolerance > 0. && std::isfinite(settings.tolerance)) || settings.max_iterations == 0)
    throw InvalidInput("tolerance and number of iterations of the damage must be positive and finite");
  if (!conditions.normal_gradients.empty())
    throw InvalidInput("a sheet with damage does not support prescribed normal gradients");
  if (constitution.has_gradient())
  {
    Constitution local(*constitution.local);
    local.factor = &field_;
    local_ = std::make_unique<Sheet>(mesh, local, settings.statics.degree);
  }
}

void DamageSolver::set_damage(const std::function<double(const Point<2> &)> &damage)
{
  if (is_loaded_)
    throw InvalidInput("the initial damage must be set before the sheet is loaded");
  field_.set(damage);
  initial_fracture_ = field_.fracture_energy();
}

unsigned int DamageSolver::step_to(const double load_factor)
{
  if (has_failed_)
    throw InvalidInput("a sheet with damage cannot be loaded after a load step that failed");
  if (!std::isfinite(load_factor))
    throw InvalidInput("the load factor must be finite");
  is_loaded_ = true;
  has_failed_ = true; // until the step is accepted
  const Sheet &sheet = statics_.sheet();
  const Sheet::Vector before = statics_.displacement();
  unsigned int n = 0;
  double change = 0.;
  do
  {
    if (n == settings_.max_iterations)
      throw SolverFailed("displacement and damage do not converge at load factor " + std::to_string(load_factor) +
                           ": the damage still changes by " + std::to_string(change),
                         SolverReport());
    statics_.step_to(load_factor);
    change = field_.minimize(sheet, statics_.displacement(), load_factor);
    ++n;
  } while (change > settings_.tolerance);
  statics_.step_to(load_factor);
  field_.accept();

  // Trapezoidal rule, eq. (C.65): forces of the last state and of this one, which act on the whole displacement.
  Sheet::Vector forces = sheet.make_owned();
  Sheet::Vector magnitude = sheet.make_owned();
  sheet.residual(statics_.displacement(), forces, magnitude, load_factor);
  Sheet::Vector rise = sheet.make_owned();
  rise = statics_.displacement();
  Sheet::Vector last = sheet.make_owned();
  last = before;
  rise -= last;
  forces_ += forces;
  const double work = 0.5 * (forces_ * rise);
  forces_ = forces;
  update_ledger(work);
  has_failed_ = false;
  return n;
}

void DamageSolver::update_ledger(const double work)
{
  const double stored = statics_.total_energy();
  ledger_.elastic = local_ ? local_->energy(statics_.displacement()) : stored;
  ledger_.gradient = stored - ledger_.elastic;
  ledger_.fracture = field_.fracture_energy() - initial_fracture_;
  ledger_.work += work;
  ledger_.imbalance = ledger_.work - stored - ledger_.fracture;
}
} // namespace latcon::continuum
