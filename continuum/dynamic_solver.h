#pragma once

#include "continuum/cell_order.h"
#include "continuum/errors.h"
#include "continuum/linear_solver.h"
#include "continuum/rate_forces.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"

#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace latcon::continuum
{
/// Mass and micro-inertia of a sheet, with kinetic energy density (rho/2) (|v|^2 + l_d^2 |Grad v|^2) [J/m^3].
struct Inertia
{
  double density;     ///< rho [kg/m^3] > 0, reference volume
  double length = 0.; ///< l_d [m] >= 0
};

/// Parameters [-] of a one-step time integrator: Newmark's formulas with beta and gamma, and the equation of motion
/// with the acceleration at t_(n+1-alpha_m) and all other terms at t_(n+1-alpha_f) (theory-continuum.md, eqs. (C.43),
/// (C.44)).
struct NewmarkParameters
{
  double alpha_m;
  double alpha_f;
  double beta;
  double gamma;

  /// Returns the generalised-alpha method of Chung and Hulbert (1993): second order, unconditionally stable for linear
  /// problems, with the least low-frequency damping for a given amplification factor rho_inf in [0, 1] of the highest
  /// frequency per step. Throws InvalidInput if rho_inf is outside [0, 1].
  static NewmarkParameters generalised_alpha(double rho_inf);

  /// Returns Newmark's average acceleration method (trapezoidal rule), without numerical damping.
  static NewmarkParameters average_acceleration() { return {0., 0., 0.25, 0.5}; }
};

/// Settings of DynamicSolver.
struct DynamicSettings
{
  double time_step;        ///< [s] > 0
  unsigned int degree = 3; ///< polynomial degree p >= 1 of the elements; p >= 2 with a gradient law
  NewmarkParameters rule = NewmarkParameters::average_acceleration();
  double relative_tolerance = 1e-10;       ///< residual relative to the acting forces [-], in (0, 1)
  unsigned int max_newton_iterations = 20; ///< per time step
  unsigned int max_step_halvings = 4;      ///< per time step that does not converge; 0: fail immediately
  bool keeps_tangent = false; ///< between steps too, while residuals fall fast; bits after archive() differ then
  LinearSettings linear = LinearSettings();
};

/// Energy balance [J/m] per unit reference thickness (theory-continuum.md, eq. (C.46)). Dissipation and work are
/// integrated over the steps since start() by the midpoint rule, to second order in the time step; energies of Maxwell
/// branches are those of theory-viscoelastic.md, eqs. (V.4) and (V.5).
struct EnergyLedger
{
  double stored = 0.;        ///< E(u), and the energy stored in Maxwell branches
  double kinetic = 0.;       ///< (1/2) v.M v, micro-inertia included
  double micro_kinetic = 0.; ///< contribution of micro-inertia to `kinetic`
  double dissipated = 0.;    ///< by viscosity and Maxwell branches
  double work = 0.;          ///< done on the sheet by dead loads and the forces on released nodes
  double released = 0.; ///< extracted from the sheet at released nodes, included in -`work`; see DynamicSolver::release
  double imbalance = 0.; ///< stored + kinetic + dissipated - work, minus the initial stored + kinetic

  /// Saves the energies to an archive or loads them from it.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("stored", stored);
    archive("kinetic", kinetic);
    archive("micro_kinetic", micro_kinetic);
    archive("dissipated", dissipated);
    archive("work", work);
    archive("imbalance", imbalance);
  }
};

/// Solves the equation of motion of a sheet at finite strain (total Lagrangian, implicit):
///   M a + C(u, v) + Q(u, q) + dE/du(u) = L
/// (theory-continuum.md, eq. (C.40)), with M the consistent mass with micro-inertia, C the viscous forces, Q those of
/// Maxwell branches with their overstresses q (theory-viscoelastic.md, eq. (V.1)) and L the dead loads. What
/// BoundaryConditions prescribe, displacements, weak normal gradients and loads, is constant in time. A sheet without
/// any condition moves freely.
///
/// Internal and viscous forces are evaluated once per residual, at the mid-state u_(n+1-alpha_f), v_(n+1-alpha_f),
/// those of Maxwell branches with the overstresses at its time. Newton's method solves each step for the displacement,
/// with a tangent that is exact where it is assembled and kept while the residual falls a hundredfold. It halves a
/// Newton step that leads to det F <= 0 anywhere. The residual converges to relative_tolerance times the acting forces,
/// or to the round-off of its own evaluation where that is larger (eq. (C.45)).
///
/// Periodic pairs constrain displacement increments and velocities, so an affine state with periodic fluctuations
/// remains one.
///
/// All functions are collective. Every exception is thrown on every rank.
class DynamicSolver
{
public:
  using Vector = Sheet::Vector;

  /// Creates a solver; start() sets the initial state. `mesh`, the laws, `viscosity` and `memory` (nullptr: none) must
  /// outlive the solver. Throws InvalidInput for numbers out of range and as Sheet does. With a viscosity the matrix of
  /// a Newton step is unsymmetric.
  DynamicSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
                const Inertia &inertia, const DynamicSettings &settings, const Viscosity *viscosity = nullptr,
                const FibreMemory *memory = nullptr);

  /// Sets the state at time 0 from nodal vectors of sheet(), `displacement` [m] and `velocity` [m/s], with or without
  /// ghost entries, for example those of a StaticSolver on the same mesh with the same degree and conditions. Solves
  /// the equation of motion for the acceleration and resets the ledger. Throws as check_start() does; NonPhysicalState
  /// or LinearSolverFailed if the acceleration cannot be computed.
  ///
  /// Maxwell branches start relaxed, or with the overstresses of a sheet that was deformed suddenly to `displacement`
  /// from the displacements `relaxed`, one for each branch by its number; empty: relaxed. Throws InvalidInput for
  /// another number of them.
  void start(const Vector &displacement, const Vector &velocity, const std::vector<Vector> &relaxed = {});

  /// Throws InvalidInput if a value of the nodal vectors is not finite, their size is not that of sheet(), or the
  /// displacement of a node differs from the prescribed one by more than 1e-8 of the sheet's extent. Collective.
  void check_start(const Vector &displacement, const Vector &velocity) const;

  /// Advances the state by one time step. A step that does not converge is repeated in two halves, recursively up to
  /// max_step_halvings. Throws SolverFailed with the history if that fails too; the state is then unchanged. Throws
  /// InvalidInput before start().
  void step();

  /// Releases nodes, for a crack that runs along an edge face by face. To be called after the caller has given faces of
  /// the mesh another boundary id, on which fewer components are prescribed: applies the conditions to the changed
  /// boundaries. The reaction at a released component ramps linearly down to zero within `duration` [s] >= 0; the
  /// energy that it extracts is EnergyLedger::released. Weak normal gradients and loads change immediately. Collective.
  ///
  /// Throws InvalidInput before start(), while reactions of an earlier release still act, if a free component would
  /// become prescribed, if there are more unknowns than LinearSettings::direct_limit, or with the gradient part of
  /// Maxwell branches.
  void release(double duration);

  /// Saves the state to an archive, or loads it in place of start() into a solver made with the same arguments on an
  /// identical mesh. A restarted run continues bit for bit on the same number of ranks, and from the same fields on
  /// another number. Not supported after release(). Throws InvalidInput after release(), for fields with another number
  /// of unknowns, and for a stored time that does not match the stored steps.
  template <class Archive>
  void archive(Archive &archive);

  double time() const { return state_.time; } ///< [s]
  /// Returns the number of time steps since start() that had to be divided.
  unsigned long n_divided_steps() const { return n_divided_steps_; }
  const EnergyLedger &ledger() const { return state_.ledger; }
  /// Returns the energies of each branch by its number [J/m], which ledger() includes.
  const std::vector<BranchEnergy> &branch_energies() const { return state_.branch_energies; }

  /// Returns the nodal reactions at unknowns with prescribed displacement, and the residual of the equation of motion
  /// at free ones [N/m], per unit reference thickness.
  Vector reactions() const;

  /// Returns the first Piola stresses [Pa] of viscosity and Maxwell branches at the points of the elastic energy, (p +
  /// 1)^2 Gauss points per cell, the cells on this rank in their order; empty without either.
  std::vector<dealii::Tensor<2, 2>> rate_stresses() const;

  // Nodal vectors with ghost entries.
  const Vector &displacement() const { return state_.displacement; } ///< [m]
  const Vector &velocity() const { return state_.velocity; }         ///< [m/s]
  /// Acceleration [m/s^2]. With generalised-alpha it approximates the acceleration at t + (alpha_m - alpha_f) *
  /// time_step, which differs to first order from that at t.
  const Vector &acceleration() const { return state_.acceleration; }
  const Sheet &sheet() const { return sheet_; }
  /// Returns the residual history of the last step with all attempts at it and its parts; empty after start() or
  /// loading.
  const SolverReport &last_report() const { return report_; }

private:
  struct Residual;
  struct Step;

  // What a step changes, beside the history of branches.
  struct State
  {
    double time = 0.;    // [s]
    Vector displacement; // [m], this and the next with ghost entries
    Vector velocity;     // [m/s]
    Vector acceleration; // [m/s^2]
    EnergyLedger ledger;
    std::vector<BranchEnergy> branch_energies;
  };

  void apply_conditions();
  double release_share(double time) const;
  void multiply_by_mass(const Sheet::Matrix &M, const Vector &x, Vector &product) const;
  Residual evaluate(const Step &step, const Vector &u) const;
  Residual best_residual(const Step &step, const Vector &first, const Vector &second, Vector &u) const;
  template <class AnyMatrix>
  void weigh_and_add_mass(const Sheet &sheet, AnyMatrix &K) const;
  Assembler level_assembler() const;
  Assembler assembler(const Vector &v);
  std::string location_of_largest(const Vector &residual) const;
  double round_off(const Residual &state, const Vector &u) const;
  std::string attempt(const Step &step, Vector &u);
  std::string advance(double duration, double end);
  std::string advance_in_parts(double duration, double end, unsigned int halvings);
  void update_energies(State &state, const Vector &v) const;
  void update_ledger(const Step &step, const Vector &u, const Vector &v, State &state) const;
  double mean_duration() const { return (1. - settings_.rule.alpha_f) * duration_; } // to the mean state [s]

  Sheet sheet_;
  Inertia inertia_;
  DynamicSettings settings_;
  double duration_; // of the current step or part of a step [s]
  RateForces rate_forces_; // with the history at the present time
  std::unique_ptr<LinearSolver> linear_solver_;
  Vector lift_;                                         // prescribed displacement, zero elsewhere
  Vector loads_;                                        // nodal dead loads
  Sheet::Matrix full_mass_;                             // condensed by the conformity constraints alone: for forces
  Sheet::Matrix plain_mass_;                            // full_mass_ without micro-inertia
  Vector elastic_diagonal_;                             // of the elastic tangent last assembled
  Vector effective_diagonal_;                           // of the matrix of the Newton step

  // Reactions at the last released nodes at the time of the release [N/m].
  Vector release_forces_;
  bool has_released_ = false;
  double release_time_ = 0.;     // [s]
  double release_duration_ = 0.; // [s]

  bool has_started_ = false;
  double initial_energy_ = 0.;
  unsigned long n_steps_ = 0;
  unsigned long n_divided_steps_ = 0;
  State state_;
  SolverReport report_;
};

template <class Archive>
void DynamicSolver::archive(Archive &archive)
{
  require(!has_released_, "a checkpoint after a release of nodes is not supported");
  archive("initial_energy", initial_energy_);
  archive("steps", n_steps_);
  archive("divided_steps", n_divided_steps_);
  archive("time", state_.time);
  archive("ledger", state_.ledger);
  require(!Archive::loads || std::abs(state_.time - n_steps_ * settings_.time_step) <=
                               4. * std::numeric_limits<double>::epsilon() * std::abs(state_.time),
          "the stored time does not match the number of stored steps");
  const NodalOrder order(sheet_);
  order.archive(archive, "displacement", state_.displacement);
  order.archive(archive, "velocity", state_.velocity);
  order.archive(archive, "acceleration", state_.acceleration);
  if (rate_forces_.n_branches() > 0)
  {
    rate_forces_.archive(archive, state_.displacement);
    archive.records("branch_energies", state_.branch_energies);
    require(state_.branch_energies.size() == rate_forces_.n_branches(),
            "the stored energies of branches are not those of the material");
  }
  // A reused multigrid preconditioner affects the round-off of every iteration.
  archive("linear_solver", *linear_solver_);
  if (linear_solver_->keeps_multigrid())
  {
    order.archive(archive, "multigrid_displacement", linear_solver_->multigrid_state());
    if constexpr (Archive::loads) // overwrites the diagonals, which are loaded next
      linear_solver_->restore(assembler(sheet_.make_ghosted()), level_assembler());
  }
  order.archive(archive, "elastic_diagonal", elastic_diagonal_);
  order.archive(archive, "effective_diagonal", effective_diagonal_);
  if constexpr (Archive::loads)
  {
    report_ = SolverReport();
    has_started_ = true;
  }
}
} // namespace latcon::continuum
