// The state from which a motion of DynamicSolver starts.
#include "continuum/collective.h"
#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{

void DynamicSolver::start(const VectorField &displacement, const VectorField &velocity, const double time)
{
  Vector u = interpolate(displacement);
  Vector v = interpolate(velocity);
  begin(u, v, time, {});
}

void DynamicSolver::start(const Vector &displacement, const Vector &velocity, const double time,
                          const std::vector<Vector> &relaxed)
{
  if (displacement.size() != sheet_.dof_handler().n_dofs() || velocity.size() != sheet_.dof_handler().n_dofs())
    throw InvalidInput("an initial nodal vector must have the size of the sheet's vectors");
  Vector u = sheet_.make_owned();
  Vector v = sheet_.make_owned();
  u = displacement;
  v = velocity;
  begin(u, v, time, relaxed);
}

bool DynamicSolver::is_prescribed(const types::global_dof_index i) const
{
  return homogeneous_.is_constrained(i) && !sheet_.conformity_constraints().is_constrained(i);
}

DynamicSolver::Vector DynamicSolver::prescribed_displacement(const double time) const
{
  Vector u = sheet_.make_owned();
  const double factor = load_factor_at(time);
  for (const types::global_dof_index i : sheet_.owned())
    if (is_prescribed(i))
      u(i) = factor * full_lift_(i);
  u.compress(VectorOperation::insert);
  return u;
}

void DynamicSolver::check_start(const Vector &u, const Vector &v, const double time) const
{
  if (!std::isfinite(time) || !std::isfinite(u.l2_norm()) || !std::isfinite(v.l2_norm()))
    throw InvalidInput("the initial time, displacement and velocity must be finite");
  double extent = 0.;
  for (const auto &cell : sheet_.mesh().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int vertex : cell->vertex_indices())
        extent = std::max(extent, cell->vertex(vertex).norm());
  extent = dealii::Utilities::MPI::max(extent, sheet_.communicator());
  const Vector prescribed = prescribed_displacement(time);
  double off = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (is_prescribed(i))
      off = std::max(off, std::abs(u(i) - prescribed(i)));
  if (!(dealii::Utilities::MPI::max(off, sheet_.communicator()) <= 1e-8 * extent))
    throw InvalidInput("the initial displacement of a boundary differs from the prescribed one");
}

void DynamicSolver::begin(Vector &u, Vector &v, const double time, const std::vector<Vector> &relaxed)
{
  check_start(u, v, time);
  const double dt = settings_.time_step;
  double factors[4]; // at the start and after one, two, three steps
  for (unsigned int k = 0; k < 4; ++k)
    factors[k] = load_factor_at(time + k * dt);

  // Prescribed unknowns follow the load factor: one-sided differences of second order, as the time integrator.
  const double rate = (-3. * factors[0] + 4. * factors[1] - factors[2]) / (2. * dt);
  const double second_rate = (2. * factors[0] - 5. * factors[1] + 4. * factors[2] - factors[3]) / (dt * dt);
  Vector a = sheet_.make_owned();
  for (const types::global_dof_index i : sheet_.owned())
    if (is_prescribed(i))
      u(i) = factors[0] * full_lift_(i);
  u.compress(VectorOperation::insert);
  prescribe(v, rate);
  prescribe(a, second_rate);

  // Solve M a = lambda L - internal and viscous forces, with prescribed a where the displacement is prescribed.
  const Vector u_ghosted = with_ghosts(u);
  const Vector v_ghosted = with_ghosts(v);
  Vector rhs = sheet_.make_owned();
  Vector forces = sheet_.make_owned();
  Vector magnitude = sheet_.make_owned();
  multiply_by_mass(full_mass_, a, rhs);
  sheet_.residual(u_ghosted, forces, magnitude, factors[0]);
  std::vector<Vector> relaxed_ghosted;
  for (const Vector &displacement : relaxed)
    relaxed_ghosted.push_back(with_ghosts(displacement));
  rate_forces_.start(u_ghosted, factors[0], relaxed_ghosted);
  rate_forces_.add_forces(0., u_ghosted, v_ghosted, {factors[0], rate}, forces, nullptr);
  rhs += forces;
  rhs.add(-factors[0], loads_);
  rhs *= -1.;
  for (const types::global_dof_index i : sheet_.owned())
    if (homogeneous_.is_constrained(i))
      rhs(i) = 0.;
  rhs.compress(VectorOperation::insert);
  Vector free_acceleration = sheet_.make_owned();
  linear_solver_->invalidate();
  const auto assemble_mass =
    [this](const Sheet &level, const Vector &, const AffineConstraints<double> &constraints, auto &M)
  {
    M = 0.;
    level.add_mass(inertia_.density, inertia_.length, constraints, M);
  };
  linear_solver_->update(u_ghosted, assemble_mass, assemble_mass);
  linear_solver_->solve(free_acceleration, rhs);
  linear_solver_->invalidate();
  homogeneous_.distribute(free_acceleration);
  a += free_acceleration;

  // Diagonals for the round-off of the residual, needed before the first Newton step.
  const unsigned int set_ups = linear_solver_->n_set_ups();
  assemble(u_ghosted, v_ghosted, {factors[0], rate});
  record_multigrid_state(set_ups, u_ghosted, factors[0]);

  displacement_ = u_ghosted;
  velocity_ = v_ghosted;
  acceleration_ = a;
  start_time_ = time_ = time;
  n_steps_ = 0;
  n_divided_steps_ = 0;
  load_factor_ = factors[0];
  ledger_ = EnergyLedger();
  report_ = SolverReport();
  branch_energies_ = rate_forces_.stored(u_ghosted, load_factor_);
  update_energies(ledger_, u, v, load_factor_, branch_energies_);
  initial_energy_ = ledger_.stored + ledger_.kinetic;
  has_started_ = true;
  has_released_ = false;
}

} // namespace latcon::continuum
