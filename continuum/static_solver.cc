#include "continuum/static_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/newton_solver.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/distributed/grid_refinement.h>
#include <deal.II/distributed/solution_transfer.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/multigrid/mg_transfer_global_coarsening.h>
#include <deal.II/numerics/error_estimator.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
struct HeldBoundary
{
  IndexSet dofs;           // held unknowns on the boundary
  Sheet::Vector tractions; // integral of its traction against each shape function [N/m]
  Tensor<1, 2> force;      // contribution of this rank [N/m]
};
} // namespace

/// Residual of the equilibrium at a displacement; see NewtonSolver.
struct StaticSolver::Evaluation
{
  Vector displacement; // with ghost entries [m]
  double stored;       // energy [J/m]
  double energy;       // minus the work of the dead loads [J/m]
  double free;         // norm of the residual over the free unknowns [N/m]
  double reference;    // norm of the nodal reactions and dead loads [N/m]
  Vector residual;     // of every unknown [N/m]
  Vector magnitude;    // sums of the absolute values of the terms of the residual [N/m]
};

StaticSolver::StaticSolver(const Sheet::Mesh &mesh, const Constitution &constitution, BoundaryConditions conditions,
                           const StaticSettings &settings)
  : sheet_(mesh, constitution, settings.degree, std::move(conditions)), settings_(settings)
{
  require(settings_.relative_tolerance > 0. && settings_.relative_tolerance < 1.,
          "the relative tolerance of the residual must be in (0, 1)");
  require(settings_.first_load_step > 0. && settings_.first_load_step <= 1., "the first load step must be in (0, 1]");
  require(settings_.smallest_load_step > 0. && settings_.smallest_load_step <= settings_.first_load_step,
          "the smallest load step must be positive and no larger than the first");
  require(settings_.largest_forcing >= 0. && settings_.largest_forcing < 1., "largest_forcing must be in [0, 1)");
  require(!sheet_.conditions().displacements.empty(),
          "static equilibrium needs a boundary with prescribed displacement");
  set_up();
}

// Sets up everything that depends on the mesh.
void StaticSolver::set_up()
{
  full_lift_ = sheet_.with_ghosts(sheet_.lift());
  loads_ = sheet_.loads();
  displacement_ = sheet_.make_ghosted();
  linear_solver_ = std::make_unique<LinearSolver>(sheet_, settings_.linear);
}

StaticSolver::Evaluation StaticSolver::evaluate(const Vector &u, const double load_factor) const
{
  Evaluation state{sheet_.with_ghosts(u), 0., 0., 0., 0., sheet_.make_owned(), sheet_.make_owned()};
  state.stored = sheet_.residual(state.displacement, state.residual, state.magnitude, load_factor);
  state.energy = state.stored - load_factor * (loads_ * u);
  state.residual.add(-load_factor, loads_);
  state.free = norm_over_free(sheet_, [&](const auto i) { return std::pow(state.residual(i), 2); });
  double given = 0.; // acting forces: reactions and dead loads
  for (const types::global_dof_index i : sheet_.owned())
  {
    if (sheet_.homogeneous_constraints().is_constrained(i))
      given += std::pow(state.residual(i), 2);
    given += std::pow(load_factor * loads_(i), 2);
  }
  state.reference = std::sqrt(dealii::Utilities::MPI::sum(given, sheet_.communicator()));
  return state;
}

// Returns the round-off of the residual, eq. (C.19) [N/m].
double StaticSolver::round_off(const Evaluation &state, const Vector &u) const
{
  const auto diagonal = [this](const types::global_dof_index i) { return linear_solver_->diag_element(i); };
  return residual_round_off(sheet_, state.magnitude, u, diagonal, diagonal);
}

std::string StaticSolver::attempt(const double target, SolverReport &report)
{
  const unsigned int number = report.load_steps.size() + 1;
  Vector rhs = sheet_.make_owned();
  Vector lift_forces = sheet_.make_owned();

  const auto assemble = [&](const Vector &at, const Vector *rise)
  {
    const Timer timer;
    double assembly = 0.; // [s]
    linear_solver_->update(
      at,
      [&](const Sheet &, const Vector &there, auto &K)
      {
        const Timer of_assembly;
        sheet_.tangent(there, sheet_.homogeneous_constraints(), K, target, rise, &lift_forces);
        assembly = of_assembly.wall_time();
      },
      [target](const Sheet &level, const Vector &there, auto &K)
      { level.tangent(there, level.homogeneous_constraints(), K, target); });
    report.times.assembly += assembly;
    report.times.preconditioner += timer.wall_time() - assembly;
  };
  const auto solve = [&](const Evaluation &state, const Vector *rise, const double forcing, Vector &step)
  {
    rhs = state.residual;
    if (rise != nullptr)
      rhs += lift_forces;
    rhs *= -1.;
    sheet_.homogeneous_constraints().set_zero(rhs);
    const Timer timer;
    const unsigned int iterations = linear_solver_->solve(step, rhs, forcing);
    report.times.linear_solve += timer.wall_time();
    const double slope = -(rhs * step); // rhs is minus the residual, zero at constrained unknowns
    sheet_.homogeneous_constraints().distribute(step);
    return NewtonStep{iterations, slope};
  };
  const auto evaluate_at = [&](const Vector &at)
  {
    const Timer timer;
    Evaluation state = evaluate(at, target);
    report.times.assembly += timer.wall_time();
    return state;
  };
  // Round-off of the energy: n terms summed, errors of random sign.
  const auto energy_noise = [&](const Evaluation &state)
  {
    const double n_points =
      static_cast<double>(sheet_.mesh().n_global_active_cells()) * dealii::Utilities::pow(sheet_.degree() + 1, 2);
    return 4. * std::numeric_limits<double>::epsilon() * std::sqrt(n_points) * std::abs(state.energy);
  };
  const NewtonSolver<Evaluation> newton{
    {settings_.relative_tolerance, settings_.max_newton_iterations, settings_.largest_forcing},
    {evaluate_at, [this](const Evaluation &state, const Vector &u) { return round_off(state, u); },
     [&](const Evaluation &state, const Vector &, const double forcing, const bool keeps_tangent, Vector &step)
     {
       if (!keeps_tangent)
         assemble(state.displacement, nullptr);
       return solve(state, nullptr, forcing, step);
     },
     energy_noise, nullptr}};

  Vector u = sheet_.without_ghosts(displacement_);
  try
  {
    // Predictor: linear response to the increment of load and prescribed displacement. Solved to round-off, because the
    // cells along held edges make its right-hand side large.
    Vector lift = full_lift_;
    lift *= target - load_factor_;
    Vector step = sheet_.make_owned();
    unsigned int linear_iterations = 0;
    // Without an increment the response is a Newton step, which needs the line search.
    if (target != load_factor_)
    {
      const Evaluation state = evaluate_at(u);
      assemble(state.displacement, &lift);
      linear_iterations = solve(state, &lift, 0., step).linear_iterations;
      u += step;
      step = lift;
      u += step;
    }
    Evaluation state = evaluate_at(u);
    const std::string failure = newton.solve(u, state, number, target, linear_iterations, report.iterations);
    if (!failure.empty())
      return failure;
    current_ = std::make_shared<const Evaluation>(std::move(state));
  }
  catch (const NoSolution &failure)
  {
    return failure.what();
  }
  displacement_ = u;
  load_factor_ = target;
  return "";
}

// Overwrites the state by the vector `u`, interpolated from another mesh, at a load factor.
void StaticSolver::start_from(Vector &u, const double load_factor)
{
  // Set boundary values from the prescribed function, which interpolation on the coarser edge may have missed.
  for (const types::global_dof_index i : sheet_.owned())
    if (sheet_.is_prescribed(i))
      u(i) = load_factor * full_lift_(i);
  u.compress(VectorOperation::insert);
  sheet_.conformity_constraints().distribute(u);
  displacement_ = u;
  load_factor_ = load_factor;
  current_.reset();
}

// Nested iteration: solves on a mesh of twice the size of cells, and starts from there. Returns false if that is
// impossible, with the state unchanged.
bool StaticSolver::solve_from_coarser_mesh(SolverReport &report)
{
  if (sheet_.mesh().n_global_levels() == 1)
    return false;
  Sheet::Mesh mesh(sheet_.communicator());
  mesh.copy_triangulation(sheet_.mesh());
  mesh.coarsen_global();
  Vector u = sheet_.make_owned();
  try
  {
    StaticSettings settings = settings_;
    // Interpolation leaves a residual of the order of the reference force.
    settings.relative_tolerance = std::max(settings.relative_tolerance, 1e-3);
    StaticSolver coarser(mesh, sheet_.constitution(), sheet_.conditions(), settings);
    report.times = coarser.solve().times; // the first of this solve

    using NodalVector = LinearAlgebra::distributed::Vector<double>;
    NodalVector from(coarser.sheet_.owned(), coarser.sheet_.relevant(), sheet_.communicator());
    NodalVector to(sheet_.owned(), sheet_.relevant(), sheet_.communicator());
    Multigrid::copy(coarser.sheet_.without_ghosts(coarser.displacement_), from);
    MGTwoLevelTransfer<2, NodalVector> transfer;
    transfer.reinit_geometric_transfer(sheet_.dof_handler(), coarser.sheet_.dof_handler(),
                                       sheet_.conformity_constraints(), coarser.sheet_.conformity_constraints());
    transfer.prolongate_and_add(to, from);
    Multigrid::copy(to, u);
  }
  catch (const SolverFailed &)
  {
    return false;
  }
  start_from(u, 1.);
  if (take_load_step(1., report))
    return true;
  displacement_ = 0.;
  load_factor_ = 0.;
  return false;
}

// Attempts to reach the load factor `target` and records the outcome. Returns whether it succeeded.
bool StaticSolver::take_load_step(const double target, SolverReport &report)
{
  const std::string failure = attempt(target, report);
  report.load_steps.push_back(
    {static_cast<unsigned int>(report.load_steps.size() + 1), target, failure.empty(), failure});
  return failure.empty();
}

SolverReport StaticSolver::solve(const Observer &observer)
{
  SolverReport report;
  const bool is_one_step = load_factor_ == 0. && settings_.first_load_step == 1.;
  const auto observe = [&]
  {
    try
    {
      if (observer)
        observer(load_factor_);
    }
    catch (const NonPhysicalState &state)
    {
      throw SolverFailed("the equilibrium at load factor " + std::to_string(load_factor_) +
                           " is inverted at an edge: " + state.what(),
                         report);
    }
  };
  if (is_one_step && !linear_solver_->is_direct() && solve_from_coarser_mesh(report))
    observe();
  double rise = settings_.first_load_step;
  constexpr unsigned int few_iterations = 5;
  while (load_factor_ < 1.)
  {
    // A remainder within rounding is added to this step.
    const double left = 1. - load_factor_;
    const double target = left <= rise * (1. + 1e-12) ? 1. : load_factor_ + rise;
    const std::size_t before = report.iterations.size();
    if (take_load_step(target, report))
    {
      if (report.iterations.size() - before <= few_iterations)
        rise *= 2.;
      observe();
    }
    else
    {
      rise = 0.5 * std::min(rise, left);
      if (rise < settings_.smallest_load_step)
        throw SolverFailed("no static equilibrium was found beyond load factor " + std::to_string(load_factor_) + ": " +
                             report.load_steps.back().reason,
                           report);
    }
  }
  linear_solver_->release(); // before results are written, which takes memory too
  return report;
}

void StaticSolver::refine(Sheet::Mesh &mesh, const double fraction)
{
  require(&mesh == &sheet_.mesh(), "refine() needs the mesh of the solver's own sheet");
  require(fraction > 0. && fraction <= 1., "the fraction of cells to refine must be in (0, 1]");
  dealii::Vector<float> jumps(mesh.n_active_cells()); // eq. (C.33)
  KellyErrorEstimator<2>::estimate(sheet_.mapping(), sheet_.dof_handler(), QGauss<1>(sheet_.degree() + 1), {},
                                   displacement_, jumps);
  // Numbers are rounded down: of a few cells one.
  const double least = std::min(1., (1. + 1e-9) / static_cast<double>(mesh.n_global_active_cells()));
  parallel::distributed::GridRefinement::refine_and_coarsen_fixed_number(mesh, jumps, std::max(fraction, least), 0.);
  mesh.prepare_coarsening_and_refinement();
  parallel::distributed::SolutionTransfer<2, Vector> transfer(sheet_.dof_handler());
  transfer.prepare_for_coarsening_and_refinement(displacement_);
  mesh.execute_coarsening_and_refinement();
  sheet_.distribute();
  set_up();

  Vector u = sheet_.make_owned();
  transfer.interpolate(u);
  start_from(u, load_factor_);
}

SolverReport StaticSolver::equilibrate()
{
  SolverReport report;
  if (!take_load_step(load_factor_, report))
    throw SolverFailed("no equilibrium was found from the state at load factor " + std::to_string(load_factor_) + ": " +
                         report.load_steps.back().reason,
                       report);
  return report;
}

const StaticSolver::Evaluation &StaticSolver::current() const
{
  if (!current_)
    current_ = std::make_shared<const Evaluation>(evaluate(sheet_.without_ghosts(displacement_), load_factor_));
  return *current_;
}

double StaticSolver::total_energy() const
{
  return current().stored;
}

// A force is the sum of the residual over the unknowns held at the boundary, so the forces add up exactly to the sum of
// the nodal reactions.
//
// The residual of a node on several held boundaries is divided between them: each gets the integral of its own
// traction P N times the shape function, and an equal part of the remainder, which vanishes under refinement
// (theory-continuum.md, eq. (C.18)).
std::map<types::boundary_id, Tensor<1, 2>> StaticSolver::reactions() const
{
  const Vector &residual = current().residual;
  std::map<types::boundary_id, HeldBoundary> boundaries;
  for (const BoundaryField &condition : sheet_.conditions().displacements)
  {
    const IndexSet held =
      DoFTools::extract_boundary_dofs(sheet_.dof_handler(), condition.components, {condition.boundary});
    const HeldBoundary none{IndexSet(held.size()), sheet_.make_owned(), {}};
    boundaries.try_emplace(condition.boundary, none).first->second.dofs.add_indices(held);
  }
  const DeferredException guarded(
    [&]
    {
      const auto &element = sheet_.element();
      FEFaceValues<2> values(sheet_.mapping(), element, QGauss<1>(sheet_.degree() + 1),
                             update_values | update_gradients | update_hessians | update_normal_vectors |
                               update_JxW_values | update_quadrature_points);
      const FEValuesExtractors::Vector displacement(0);
      std::vector<Tensor<2, 2>> F(values.n_quadrature_points);
      std::vector<Tensor<3, 2>> G(values.n_quadrature_points);
      std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
      dealii::Vector<double> forces(element.n_dofs_per_cell());
      const auto add = [&](const auto &cell, const unsigned int face, Sheet::Vector &tractions)
      {
        values.reinit(cell, face);
        values[displacement].get_function_gradients(displacement_, F);
        values[displacement].get_function_hessians(displacement_, G);
        forces = 0.;
        for (unsigned int q = 0; q < F.size(); ++q)
        {
          for (unsigned int i = 0; i < 2; ++i)
            F[q][i][i] += 1.;
          const Tensor<1, 2> traction =
            sheet_.constitution().evaluate(values.quadrature_point(q), F[q], G[q]).first_piola *
            values.normal_vector(q) * values.JxW(q);
          for (unsigned int a = 0; a < dofs.size(); ++a)
            forces[a] += traction[element.system_to_component_index(a).first] * values.shape_value(a, q);
        }
        cell->get_dof_indices(dofs);
        sheet_.conformity_constraints().distribute_local_to_global(forces, dofs, tractions);
      };
      for (const auto &cell : sheet_.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
        for (const unsigned int face : cell->face_indices())
          if (const auto held = boundaries.find(cell->face(face)->boundary_id()); held != boundaries.end())
            add(cell, face, held->second.tractions);
    });
  for (auto &[id, boundary] : boundaries)
    boundary.tractions.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet_.communicator());

  const std::vector<IndexSet> owned = DoFTools::locally_owned_dofs_per_component(sheet_.dof_handler());
  for (unsigned int component = 0; component < 2; ++component)
    for (const types::global_dof_index i : owned[component])
    {
      double rest = residual(i);
      unsigned int n = 0;
      for (const auto &[id, boundary] : boundaries)
        if (boundary.dofs.is_element(i))
        {
          rest -= boundary.tractions(i);
          ++n;
        }
      for (auto &[id, boundary] : boundaries)
        if (boundary.dofs.is_element(i))
          boundary.force[component] += boundary.tractions(i) + rest / n;
    }

  std::map<types::boundary_id, Tensor<1, 2>> forces;
  for (const auto &[id, boundary] : boundaries)
    forces[id] = dealii::Utilities::MPI::sum(boundary.force, sheet_.communicator());
  return forces;
}
} // namespace latcon::continuum
