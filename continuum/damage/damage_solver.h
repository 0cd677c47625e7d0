#pragma once

#include "continuum/damage/damage_field.h"
#include "continuum/static_solver.h"

#include <memory>

namespace latcon::continuum
{
/// Settings of DamageSolver.
struct DamageSettings
{
  /// Largest change of damage at any node [-] in the last iteration of a load step, > 0 and finite.
  double tolerance = 1e-6;
  unsigned int max_iterations = 2000; ///< per load step, > 0
  StaticSettings statics;
};

/// Energies of a damaged sheet since its load factor was 0 [J/m], per unit reference thickness.
struct DamageLedger
{
  double elastic = 0.;   ///< integral of g W
  double gradient = 0.;  ///< integral of g W_g, and the terms on faces
  double fracture = 0.;  ///< S(phi), without that of the initial damage
  double work = 0.;      ///< done on the sheet by prescribed displacements and dead loads
  double imbalance = 0.; ///< work - elastic - gradient - fracture, eq. (C.65)
};

/// Quasi-static loading of a sheet with damage: in every load step displacement and damage are minimised in turn until
/// neither changes, from the state of the previous step (theory-damage.md, "Damage"). The energy E(u, phi) falls in
/// every iteration. The result is a state in which neither field alone can lower the energy, not necessarily the lowest
/// minimum. Where the sheet softens faster than it unloads, a crack runs within one load step; energy that a dynamic
/// crack would carry away is then missing from the ledger: `imbalance` is positive.
///
/// All functions are collective.
class DamageSolver
{
public:
  /// Creates a solver at load factor 0, without damage. `mesh`, which must not change, and the laws must outlive it. On
  /// `intact` boundaries damage keeps the value of set_damage(), 0 by default. Throws InvalidInput as StaticSolver and
  /// DamageField do, for settings out of range, for a constitution that has a stiffness factor, and for prescribed
  /// normal gradients, whose work the ledger does not include.
  DamageSolver(const Sheet::Mesh &mesh, const Constitution &constitution, const BoundaryConditions &conditions,
               const DamageLaw &law, const std::set<dealii::types::boundary_id> &intact = {},
               const DamageSettings &settings = DamageSettings());

  /// Sets the damage, and its lower bound, of a sheet that has not been loaded; see DamageField::set. Throws
  /// InvalidInput after the first load step, also at load factor 0: damage does not heal.
  void set_damage(const std::function<double(const dealii::Point<2> &)> &damage);

  /// Loads to `load_factor` [-], larger or smaller than the current one, in one step. Returns the number of iterations.
  /// Throws SolverFailed if the displacement does not converge in an iteration, or displacement and damage do not in
  /// max_iterations, and as DamageField::minimize does. ledger() is then still that of the last accepted step; field()
  /// and statics() are in the state of the failure, which belongs to no equilibrium, so that the solver cannot be
  /// loaded further. Throws InvalidInput after such a failure, and for a load factor that is not finite.
  unsigned int step_to(double load_factor);

  const DamageLedger &ledger() const { return ledger_; }
  const DamageField &field() const { return field_; }
  const StaticSolver &statics() const { return statics_; }

private:
  void update_ledger(double work);

  DamageSettings settings_;
  DamageField field_;
  StaticSolver statics_;
  std::unique_ptr<Sheet> local_; // without gradient energy
  DamageLedger ledger_;
  double initial_fracture_ = 0.;
  bool is_loaded_ = false;  // a load step began
  bool has_failed_ = false; // a load step began and did not end
  Sheet::Vector forces_;    // dE/du of the last state [N/m]
};
} // namespace latcon::continuum
