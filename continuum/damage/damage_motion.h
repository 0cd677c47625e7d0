#pragma once

#include "continuum/damage/gradient_forces.h"
#include "continuum/damage/mass_operator.h"
#include "continuum/damage/viscous_stages.h"
#include "continuum/errors.h"

#include <functional>
#include <optional>

namespace latcon::continuum
{
/// A sheet in motion with damage.
struct DamageMotionSetup
{
  Rectangle rectangle;
  dealii::Tensor<2, 2> loading; ///< F_0 [-]; displacements are relative to it
  std::vector<FibreFamily> families;
  std::vector<FibreDashpot> dashpots; ///< may be empty
  double density;                     ///< rho > 0 [kg/m^3] of the undamaged material
  DamageLaw damage;
  /// Returns true where component i of the position x = F_0 X is prescribed, for ever. The argument is a node.
  std::function<bool(const dealii::Point<2> &, unsigned int i)> is_held;
  /// Returns true for nodes whose initial damage does not change; empty: none.
  std::function<bool(const dealii::Point<2> &)> is_intact;
  double step;                                          ///< [s] > 0
  std::optional<GradientSetup> gradient = std::nullopt; ///< none: local law
  MPI_Comm communicator = MPI_COMM_SELF;                ///< ranks that share the sheet
};

/// Energies of a sheet in motion with damage [J/m], per unit reference thickness, eq. (C.74).
struct DamageMotionLedger
{
  double elastic = 0.;   ///< sum of g_c E_c
  double kinetic = 0.;   ///< sum of m_a |v_a|^2 / 2, and that of the micro-inertia
  double viscous = 0.;   ///< dissipated since the start
  double fracture = 0.;  ///< S(phi), without that of the initial damage
  double shed = 0.;      ///< kinetic energy of the mass that was removed with damage
  double imbalance = 0.; ///< initial energy - all of the others
  double gradient = 0.;  ///< sum of g(phi_a) E^g_a

  /// Saves or loads the energies, for checkpoints.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("elastic", elastic);
    archive("kinetic", kinetic);
    archive("viscous", viscous);
    archive("fracture", fracture);
    archive("shed", shed);
    archive("imbalance", imbalance);
    archive("gradient", gradient);
  }
};

/// Motion of a sheet of fibres with damage on a uniform grid of bilinear elements, mass, stress and viscosity degraded
/// alike (theory-damage.md, "Motion with damage", eqs. (C.69) to (C.74)): the waves of damaged material are as fast
/// as those of intact material, and damage does not limit the time step. Held nodes do not move, so that edges do no
/// work; other edges are free. Optionally there are a gradient energy and micro-inertia (theory-damage.md, "Gradient
/// energy in motion", eqs. (C.75) to (C.81)).
///
/// Steps are explicit: Runge-Kutta-Chebyshev with as many stages as the viscosity requires, or velocity Verlet without
/// viscosity. After each step the damage is minimised at fixed displacement and velocity.
///
/// Ranks share the forces, the energies and the division by the mass, in bands of rows; each rank has the whole sheet,
/// combines the stages and minimises the damage. Bits do not depend on the numbers of ranks and threads. All functions
/// that compute are collective, and all ranks throw, or none.
class DamageMotion
{
public:
  /// Creates a homogeneous sheet x = F_0 X at rest. Throws InvalidInput and InvalidMaterial as NodeGrid, GridDamage,
  /// FibreForces, GradientForces, MassOperator and ViscousStages do, for a density or step that is not positive and
  /// finite, and, without viscosity, for a step beyond stable_step().
  explicit DamageMotion(const DamageMotionSetup &setup);

  /// Sets the excess displacement u = x - F_0 X [m] and the velocity [m/s] of the nodes, except held components.
  /// Restarts the ledger.
  void set_motion(const std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> &displacement,
                  const std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> &velocity);

  /// Sets the nodal damage [-], such as that of a seed crack. Restarts the ledger. Throws InvalidInput for values out
  /// of [0, 1].
  void set_damage(const std::function<double(const dealii::Point<2> &)> &damage);

  /// Minimises the damage at the present displacement, which is that of a seed crack under the loading, and restarts
  /// the ledger. Without it the first step does so, and the energy that a jump of the damage loses is a remainder of
  /// the ledger that no shorter step reduces. Throws NonPhysicalState as GridDamage::minimize does.
  void settle_damage();

  /// Advances by one step. Throws NonPhysicalState as FibreForces::energies and GridDamage::minimize do; the state is
  /// then that before the step.
  void advance();

  double time() const { return static_cast<double>(n_steps_) * setup_.step; } ///< [s]
  std::size_t n_steps() const { return n_steps_; }
  const DamageMotionLedger &ledger() const { return ledger_; }
  const GridDamage &damage() const { return damage_; }
  const NodeGrid &grid() const { return forces_.grid(); }
  const GridVector &displacement() const { return u_; } ///< excess over F_0 X [m]
  const GridVector &velocity() const { return v_; }     ///< [m/s]
  /// Energies E_c of the undegraded cells [J/m], by the index of a cell.
  const std::vector<double> &cell_energies() const { return cell_energies_; }
  unsigned int n_stages() const { return stages_ ? static_cast<unsigned int>(stages_->stages().size()) + 1 : 1; }

  /// Returns the longest stable step [s] of velocity Verlet, without viscosity, at F_0 and where fibres have shortened
  /// to FibreForces::relaxed_stretch. With viscosity, the constructor refuses steps in which waves of such a sheet
  /// grow.
  double stable_step() const;

  /// Saves the motion, or loads it into one of the same setup, which continues bitwise. `archive` is called with names
  /// and values; `Archive::loads` is true if it loads. Throws InvalidInput for values of another grid and for damage
  /// out of [0, 1].
  template <class Archive>
  void archive(Archive &archive)
  {
    std::vector<double> damage = damage_.nodal();
    archive("n_steps", n_steps_);
    archive("displacement_x", u_[0]);
    archive("displacement_y", u_[1]);
    archive("velocity_x", v_[0]);
    archive("velocity_y", v_[1]);
    archive("damage", damage);
    archive("ledger", ledger_);
    archive("initial_energy", initial_energy_);
    archive("initial_fracture", initial_fracture_);
    if constexpr (Archive::loads)
      resume(damage);
  }

private:
  void resume(const std::vector<double> &damage)
  {
    for (const std::vector<double> *values : {&u_[0], &u_[1], &v_[0], &v_[1]})
      if (values->size() != grid().n_nodes())
        throw InvalidInput("a motion with damage was saved on another grid");
    damage_.set(damage);
    update_masses();
    compute_energies();
  }
  double viscous_rate() const;
  void restart_ledger();
  void step();
  void update_masses() { mass_.update(damage_.cell_factors()); }
  void compute_energies();
  void update_energies();
  void accelerate(const GridVector &u, const GridVector &v, GridVector &acceleration, double &power) const;
  void advance_viscous();
  void advance_elastic();

  DamageMotionSetup setup_;
  FibreForces forces_;
  GridDamage damage_;
  std::array<std::vector<char>, 2> held_;
  std::optional<GradientForces> gradient_; // none without gradient energy
  MassOperator mass_;
  std::optional<ViscousStages> stages_;               // none without viscosity
  std::vector<double> cell_energies_, node_energies_; // [J/m]
  GridVector u_, v_;
  std::size_t n_steps_ = 0;
  DamageMotionLedger ledger_;
  double initial_energy_ = 0., initial_fracture_ = 0.; // [J/m]
};
} // namespace latcon::continuum
