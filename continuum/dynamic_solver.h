#pragma once

#include "continuum/errors.h"
#include "continuum/linear_solver.h"
#include "continuum/nodal_order.h"
#include "continuum/sheet.h"
#include "continuum/solver_report.h"
#include "continuum/viscous_forces.h"

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace latcon::continuum
{
/// Mass and micro-inertia: kinetic energy density (rho/2) (|v|^2 + l_d^2 |Grad v|^2) [J/m^3].
struct Inertia
{
  double density;     ///< rho [kg/m^3] > 0, reference volume
  double length = 0.; ///< l_d [m] >= 0
};

/// A one-step rule for the second-order equation in time: Newmark's formulas with beta, gamma, and the equation of
/// motion asked for with the acceleration at t_(n+1-alpha_m) and all else at t_(n+1-alpha_f) (theory-continuum.md,
/// eqs. (C.43), (C.44)). The numbers are [-].
struct NewmarkParameters
{
  double alpha_m;
  double alpha_f;
  double beta;
  double gamma;

  /// Generalised-alpha after Chung and Hulbert: second order, unconditionally stable when linear, with the least
  /// damping of low frequencies for an amplification rho_inf in [0, 1] of the highest in each step. Throws
  /// InvalidInput for another rho_inf.
  static NewmarkParameters generalised_alpha(double rho_inf);

  /// Newmark's average acceleration, the trapezoidal rule: no damping.
  static NewmarkParameters average_acceleration() { return {0., 0., 0.25, 0.5}; }
};

/// How motion is followed. Viscosity at finite strain makes the matrix of a Newton step unsymmetric.
struct DynamicSettings
{
  double time_step;        ///< [s] > 0
  unsigned int degree = 3; ///< of the elements, p >= 1; p >= 2 with a gradient law
  NewmarkParameters rule = NewmarkParameters::average_acceleration();
  double relative_tolerance = 1e-10;       ///< residual over the forces at work [-], in (0, 1)
  unsigned int max_newton_iterations = 20; ///< per time step
  unsigned int max_halvings = 10;          ///< of a Newton step that leaves det F <= 0
  unsigned int max_step_halvings = 4;      ///< of a time step that cannot be solved; 0: it fails at once
  LinearSettings linear = LinearSettings();
};

/// Where the energy is and where it came from [J/m], per unit reference thickness (theory-continuum.md, eq. (C.46)).
/// What has gone by is summed over the steps since start() by the midpoint rule, to second order in the time step.
struct EnergyLedger
{
  double stored = 0.;        ///< E(u)
  double kinetic = 0.;       ///< (1/2) v.M v, micro-inertia included
  double micro_kinetic = 0.; ///< the share of micro-inertia in `kinetic`
  double dissipated = 0.;    ///< by viscosity
  double work = 0.;          ///< done on the sheet by held boundaries, dead loads and nodes that are let go
  double released = 0.;      ///< taken from the sheet by nodes that are let go, in -`work`; see DynamicSolver::release
  double imbalance = 0.;     ///< stored + kinetic + dissipated - work, less stored + kinetic at the start

  /// Stores the numbers in an archive, or takes them from there.
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

/// Motion of a sheet at finite strain, total Lagrangian:
///   M a + C(u, v) + dE/du(u) = lambda(t) L
/// (theory-continuum.md, eq. (C.40)), with M the consistent mass with micro-inertia, C the viscous forces and L the
/// dead loads. Everything that BoundaryConditions prescribe is multiplied by the load factor lambda(t): displacements
/// of held boundaries, which move as u(X, t) = lambda(t) u(X), weak normal gradients and loads. No condition is needed:
/// a sheet may be free.
///
/// Internal and viscous forces are those of the mid-state u_(n+1-alpha_f), v_(n+1-alpha_f), the load factor the
/// same mean of its values at both ends; the state of the mean, not the mean of the forces, so that one evaluation
/// serves. Each step is solved for the displacement by Newton with the exact tangent. A Newton step that leaves det F
/// <= 0 anywhere is halved. The residual is held to relative_tolerance times the forces at work, or to the round-off of
/// its own evaluation where that is larger (eq. (C.45)).
///
/// Held boundaries get their velocity and acceleration from lambda(t) by one-sided differences at the start, and from
/// Newmark's formulas afterwards. Periodic pairs bind the increments of displacement and the velocities, so a state
/// that is affine and periodic stays one.
///
/// All functions are collective, and every exception reaches every rank.
class DynamicSolver
{
public:
  using Vector = Sheet::Vector;
  using LoadFactor = std::function<double(double time)>; ///< [-], of the time [s]
  using Observer = std::function<void()>;                ///< called after every step

  /// `mesh`, the laws and `viscosity` (none: nullptr) must outlive the solver; `load_factor` empty stands for 1 at all
  /// times. Throws InvalidInput for numbers out of range, or what Sheet refuses.
  DynamicSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
                const Inertia &inertia, const DynamicSettings &settings, const Viscosity *viscosity = nullptr,
                LoadFactor load_factor = LoadFactor());

  /// Begins at `time` [s] with the fields `displacement` [m] and `velocity` [m/s], interpolated; a null field is zero.
  /// The acceleration follows from the equation of motion, the ledger starts anew. Throws InvalidInput if the
  /// displacement of a held node is not lambda(time) times the prescribed one, to 1e-8 of the sheet's extent;
  /// NonPhysicalState or LinearSolverFailed if there is no acceleration.
  void start(const VectorField &displacement = VectorField(), const VectorField &velocity = VectorField(),
             double time = 0.);

  /// The same with nodal vectors of sheet(), with or without ghost entries: of a StaticSolver on the same mesh with the
  /// same degree and conditions, for one.
  void start(const Vector &displacement, const Vector &velocity, double time = 0.);

  /// Throws InvalidInput for nodal vectors that start() refuses: not finite, or not what is prescribed on a held
  /// boundary at that time. Collective.
  void check_start(const Vector &displacement, const Vector &velocity, double time = 0.) const;

  /// Displacement that is prescribed on held boundaries at `time` [s], zero elsewhere [m]. Collective.
  Vector prescribed_displacement(double time = 0.) const;

  /// One time step. One that cannot be solved is repeated from its start in two halves, and these likewise; throws
  /// SolverFailed with the history if that does not help either, and the state is then the one before. Throws
  /// InvalidInput before start().
  void step();

  /// Steps until the time is `end` [s] or, for want of a whole step, up to one step later. Throws as step().
  void run_until(double end, const Observer &observer = Observer());

  /// Lets nodes go: applies the conditions to the mesh as it is now, after the caller has moved faces of its mesh to
  /// another boundary id, on which fewer components are held. The force that held a component until now acts on, and
  /// falls linearly to zero within `duration` [s] >= 0; what it takes from the sheet is EnergyLedger::released. So a
  /// crack runs along an edge, face by face. Weak normal gradients and loads change at once. Collective.
  ///
  /// Throws InvalidInput before start(), while nodes let go before are still pulled, if a component would be held that
  /// was free, or if there are more unknowns than the direct solver takes.
  void release(double duration);

  /// Stores all that the steps to come depend on, or takes it from there in place of a start, in a solver made with the
  /// same arguments on a like mesh: on as many ranks the motion then goes on with the same bits as if it had never been
  /// stopped, on another number with the same fields. Not supported after release(). Throws InvalidInput then, for
  /// fields of another number of unknowns, and for a time that is not that of the steps.
  template <class Archive>
  void archive(Archive &archive);

  double time() const { return time_; } ///< [s]
  /// Time steps that were made in parts since start().
  unsigned long n_divided_steps() const { return n_divided_steps_; }
  double load_factor() const { return load_factor_; }
  const EnergyLedger &ledger() const { return ledger_; }

  /// Momentum [kg/s], per unit reference thickness.
  dealii::Tensor<1, 2> momentum() const;

  /// States at reference points [m]; see Sheet::evaluate. Viscous stress is not in them.
  std::vector<PointState> evaluate(const std::vector<dealii::Point<2>> &points) const;

  // Nodal vectors with ghost entries.
  const Vector &displacement() const { return displacement_; } ///< [m]
  const Vector &velocity() const { return velocity_; }         ///< [m/s]
  /// [m/s^2]. With generalised-alpha, that of the time t + (alpha_m - alpha_f) * time_step, which differs from
  /// that of the time t to first order.
  const Vector &acceleration() const { return acceleration_; }
  const Sheet &sheet() const { return sheet_; }
  /// Residuals of the last step, every attempt at it or at parts of it; none at the start or from an archive.
  const SolverReport &last_report() const { return report_; }

private:
  struct Residual;
  struct Step;

  void check_input() const;
  void check_loaded() const;
  void set_up();
  void apply_conditions();
  double release_share(double time) const;
  Vector reactions() const;
  double load_factor_at(double time) const;
  Vector interpolate(const VectorField &field) const;
  bool is_prescribed(dealii::types::global_dof_index i) const;
  void begin(Vector &u, Vector &v, double time);
  Vector ghosted(const Vector &owned) const;
  void multiply_by_mass(const Sheet::Matrix &M, const Vector &x, Vector &product) const;
  Residual evaluate(const Step &step, const Vector &u) const;
  Residual best_residual(const Step &step, const Vector &first, const Vector &second, Vector &u) const;
  const Sheet::Matrix &level_mass(const Sheet &level, const dealii::AffineConstraints<double> &constraints);
  Multigrid::Assembler level_assembler(double load_factor);
  void assemble_matrix(const Vector &u, const Vector &v, double load_factor);
  void assemble(const Vector &u, const Vector &v, double load_factor);
  void note_multigrid(unsigned int before, const Vector &u, double load_factor);
  void restore_multigrid();
  std::string place_of_largest(const Vector &residual) const;
  double norm_over_free(const Vector &x) const;
  double round_off(const Residual &state, const Vector &u) const;
  std::string attempt(Step &step, Vector &u);
  std::string advance(double duration, double end);
  std::string advance_in_parts(double duration, double end, unsigned int halvings);
  EnergyLedger ledger_after(const Step &step, const Vector &u, const Vector &v) const;
  void update_energies(EnergyLedger &ledger, const Vector &u, const Vector &v, double load_factor) const;

  Sheet sheet_;
  Inertia inertia_;
  DynamicSettings settings_;
  double duration_; // of the step, or the part of one, that is being solved [s]
  const Viscosity *viscosity_;
  ViscousForces viscous_forces_;
  LoadFactor given_load_factor_;
  std::unique_ptr<LinearSolver> linear_solver_;
  dealii::AffineConstraints<double> homogeneous_;       // what makes the field one, and held unknowns at zero
  Vector full_lift_;                                    // prescribed displacement at load factor 1, zero elsewhere
  Vector loads_;                                        // nodal dead loads at load factor 1
  double smallest_cell_ = 0.;                           // extent [m]
  Sheet::Matrix mass_;                                  // condensed by homogeneous_: for solving
  Sheet::Matrix full_mass_;                             // condensed by the conformity constraints alone: for forces
  Sheet::Matrix plain_mass_;                            // the same without micro-inertia
  Sheet::Matrix matrix_;                                // of the Newton step
  std::map<const Sheet *, Sheet::Matrix> level_masses_; // of coarser meshes of multigrid, once they are needed
  Vector elastic_diagonal_;                             // of the elastic tangent last assembled
  Vector effective_diagonal_;                           // of matrix_

  // Where the multigrid that the linear solver keeps was set up, with ghost entries: from there it can be made again.
  Vector multigrid_displacement_;
  double multigrid_load_factor_ = 0.;

  // Forces on the nodes let go last, when they were [N/m].
  Vector release_forces_;
  bool has_released_ = false;
  double release_time_ = 0.;     // [s]
  double release_duration_ = 0.; // [s]

  bool has_started_ = false;
  double start_time_ = 0.;
  double initial_energy_ = 0.;
  unsigned long n_steps_ = 0;
  unsigned long n_divided_steps_ = 0;
  double time_ = 0.;
  double load_factor_ = 0.;
  Vector displacement_;
  Vector velocity_;
  Vector acceleration_;
  EnergyLedger ledger_;
  SolverReport report_;
};

template <class Archive>
void DynamicSolver::archive(Archive &archive)
{
  if (has_released_)
    throw InvalidInput("a motion in which nodes were let go cannot be archived");
  archive("start_time", start_time_);
  archive("initial_energy", initial_energy_);
  archive("steps", n_steps_);
  archive("divided_steps", n_divided_steps_);
  archive("time", time_);
  archive("load_factor", load_factor_);
  archive("ledger", ledger_);
  if constexpr (Archive::loads)
    check_loaded();
  const NodalOrder order(sheet_);
  order.archive(archive, "displacement", displacement_);
  order.archive(archive, "velocity", velocity_);
  order.archive(archive, "acceleration", acceleration_);
  // A multigrid that is kept has a part in the round-off of every iteration.
  archive("linear_solver", *linear_solver_);
  if (linear_solver_->keeps_multigrid())
  {
    archive("multigrid_load_factor", multigrid_load_factor_);
    order.archive(archive, "multigrid_displacement", multigrid_displacement_);
    if constexpr (Archive::loads)
      restore_multigrid(); // which leaves other diagonals
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
