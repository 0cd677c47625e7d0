#include "continuum/static_solver.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/reactions.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace dealii;

namespace continuum
{
/// What Newton has to know of a state.
struct StaticSolver::Evaluation
{
  double energy;    // [J/m]
  double free;      // norm of the residual over the free unknowns [N/m]
  double reference; // norm of the nodal reactions [N/m]
  Vector residual;  // of every unknown [N/m]
  Vector magnitude; // sums of absolute values behind the residual [N/m]
};

StaticSolver::StaticSolver(const parallel::distributed::Triangulation<2> &mesh, const Material &law,
                           std::vector<PrescribedDisplacement> conditions, const StaticSettings &settings)
  : sheet_(mesh, law, settings.degree), conditions_(std::move(conditions)), settings_(settings),
    linear_solver_(sheet_, settings.linear), displacement_(sheet_.make_ghosted())
{
  check_input();
  hold_boundaries();
  TrilinosWrappers::SparsityPattern pattern(sheet_.owned(), sheet_.owned(), sheet_.relevant(), sheet_.communicator());
  DoFTools::make_sparsity_pattern(sheet_.dof_handler(), pattern, homogeneous_, false,
                                  Utilities::MPI::this_mpi_process(sheet_.communicator()));
  pattern.compress();
  matrix_.reinit(pattern);
}

void StaticSolver::check_input() const
{
  const auto require = [](const bool holds, const std::string &rule)
  {
    if (!holds)
      throw InvalidInput(rule);
  };
  require(settings_.relative_tolerance > 0. && settings_.relative_tolerance < 1.,
          "the relative tolerance of the residual must lie between 0 and 1");
  require(settings_.first_load_step > 0. && settings_.first_load_step <= 1., "the first load step must lie in (0, 1]");
  require(settings_.smallest_load_step > 0. && settings_.smallest_load_step <= settings_.first_load_step,
          "the smallest load step must be positive and no larger than the first");
  require(!conditions_.empty(), "a sheet needs a boundary with prescribed displacement");
  const auto ids = sheet_.mesh().get_boundary_ids();
  for (const PrescribedDisplacement &condition : conditions_)
  {
    require(std::find(ids.begin(), ids.end(), condition.boundary) != ids.end(),
            "the mesh has no boundary with id " + std::to_string(condition.boundary));
    require(condition.displacement && condition.displacement->n_components == 2,
            "a prescribed displacement needs a function of two components");
    require(condition.components.represents_n_components(2) && condition.components.n_selected_components(2) > 0,
            "a prescribed displacement needs a mask of two components, one of them selected");
  }
}

void StaticSolver::hold_boundaries()
{
  AffineConstraints<double> given(sheet_.relevant());
  given.merge(sheet_.hanging_nodes());
  collectively(sheet_.communicator(),
               [&]
               {
                 for (const PrescribedDisplacement &condition : conditions_)
                   VectorTools::interpolate_boundary_values(sheet_.mapping(), sheet_.dof_handler(), condition.boundary,
                                                            *condition.displacement, given, condition.components);
               });

  Vector lift = sheet_.make_owned();
  for (const types::global_dof_index i : sheet_.owned())
    if (given.is_constrained(i) && !sheet_.hanging_nodes().is_constrained(i))
      lift(i) = given.get_inhomogeneity(i);
  lift.compress(VectorOperation::insert);
  sheet_.hanging_nodes().distribute(lift);
  full_lift_ = sheet_.make_ghosted();
  full_lift_ = lift;

  homogeneous_.copy_from(given);
  for (const types::global_dof_index i : sheet_.relevant())
    if (homogeneous_.is_constrained(i))
      homogeneous_.set_inhomogeneity(i, 0.);
  homogeneous_.close();
}

StaticSolver::Evaluation StaticSolver::look_at(const Vector &u) const
{
  Evaluation state{0., 0., 0., sheet_.make_owned(), sheet_.make_owned()};
  state.energy = sheet_.energy(u);
  sheet_.residual(u, state.residual, state.magnitude);
  double free = 0.;
  double held = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    (homogeneous_.is_constrained(i) ? held : free) += state.residual(i) * state.residual(i);
  state.free = std::sqrt(Utilities::MPI::sum(free, sheet_.communicator()));
  state.reference = std::sqrt(Utilities::MPI::sum(held, sheet_.communicator()));
  return state;
}

// The floor of eq. (C.19).
double StaticSolver::round_off(const Evaluation &state, const Vector &u) const
{
  double sum = 0.;
  for (const types::global_dof_index i : sheet_.owned())
    if (!homogeneous_.is_constrained(i))
    {
      const double of_stress = state.magnitude(i);
      const double of_displacement = matrix_.diag_element(i) * u(i);
      sum += of_stress * of_stress + of_displacement * of_displacement;
    }
  // Four: a stress takes several roundings after those of the displacement.
  return 4. * std::numeric_limits<double>::epsilon() * std::sqrt(Utilities::MPI::sum(sum, sheet_.communicator()));
}

std::string StaticSolver::attempt(const double target, SolverReport &report)
{
  const unsigned int number = report.load_steps.size() + 1;
  Vector u = sheet_.make_ghosted();   // accepted so far within this load step
  Vector trial = sheet_.make_owned(); // being written
  Vector step = sheet_.make_owned();  // Newton step, or predictor
  Vector rhs = sheet_.make_owned();
  Vector lift = sheet_.make_ghosted(); // rise of the prescribed displacement still to be made
  Vector lift_forces = sheet_.make_owned();

  const auto solve = [&](const Evaluation &state, const Vector &at)
  {
    sheet_.tangent(at, homogeneous_, matrix_, lift, lift_forces);
    rhs = state.residual;
    rhs += lift_forces;
    rhs *= -1.;
    for (const types::global_dof_index i : sheet_.owned())
      if (homogeneous_.is_constrained(i))
        rhs(i) = 0.;
    rhs.compress(VectorOperation::insert);
    const unsigned int iterations = linear_solver_.solve(matrix_, step, rhs);
    homogeneous_.distribute(step);
    return iterations;
  };

  try
  {
    // Predictor: the linear response to the rise of the boundary displacement.
    lift = full_lift_;
    lift *= target - load_factor_;
    unsigned int linear_iterations = solve(look_at(displacement_), displacement_);
    trial = displacement_;
    trial += step;
    step = lift;
    trial += step;
    u = trial;
    lift = 0.;
    double length = 1.;

    for (unsigned int iteration = 0;; ++iteration)
    {
      const Evaluation state = look_at(u);
      const double floor = round_off(state, u);
      const double tolerance = std::max(settings_.relative_tolerance * state.reference, floor);
      report.iterations.push_back(
        {number, iteration, target, state.free, tolerance, state.energy, length, linear_iterations});
      if (state.free <= tolerance)
        break;
      if (iteration == settings_.max_newton_iterations)
        return "no convergence in " + std::to_string(iteration) + " Newton iterations";

      linear_iterations = solve(state, u);
      const double slope = -(rhs * step); // dE along the step; rhs is minus the residual, zero where held
      if (!(slope < 0.))
        return "the tangent is not positive definite along the Newton step";

      // Energies closer than their round-off cannot be told apart: n terms summed, errors of random sign.
      const double n_points =
        static_cast<double>(sheet_.mesh().n_global_active_cells()) * Utilities::pow(sheet_.degree() + 1, 2);
      const double noise = 4. * std::numeric_limits<double>::epsilon() * std::sqrt(n_points) * std::abs(state.energy);
      length = 1.;
      std::string reason;
      for (unsigned int halvings = 0;; ++halvings, length *= 0.5)
      {
        if (halvings > settings_.max_halvings)
          return "the line search found no decrease of energy" + reason;
        trial = u;
        trial.add(length, step);
        Vector candidate = sheet_.make_ghosted();
        candidate = trial;
        try
        {
          if (sheet_.energy(candidate) <= state.energy + 1e-4 * length * slope + noise)
          {
            u = candidate;
            break;
          }
        }
        catch (const NonPhysicalState &failure)
        {
          reason = std::string("; last refused state: ") + failure.what();
        }
      }
    }
  }
  catch (const NonPhysicalState &failure)
  {
    return failure.what();
  }
  catch (const LinearSolverFailed &failure)
  {
    return failure.what();
  }
  displacement_ = u;
  load_factor_ = target;
  return "";
}

SolverReport StaticSolver::solve(const Observer &observer)
{
  SolverReport report;
  double rise = settings_.first_load_step;
  constexpr unsigned int few_iterations = 5;
  while (load_factor_ < 1.)
  {
    // A remainder within rounding of the step is taken along rather than left as a step of its own.
    const double left = 1. - load_factor_;
    const double target = left <= rise * (1. + 1e-12) ? 1. : load_factor_ + rise;
    const std::size_t before = report.iterations.size();
    const std::string failure = attempt(target, report);
    report.load_steps.push_back(
      {static_cast<unsigned int>(report.load_steps.size() + 1), target, failure.empty(), failure});
    report.load_factor = load_factor_;
    if (failure.empty())
    {
      if (report.iterations.size() - before <= few_iterations)
        rise *= 2.;
      if (observer)
        observer(load_factor_);
    }
    else
    {
      rise = 0.5 * std::min(rise, left);
      if (rise < settings_.smallest_load_step)
        throw SolverFailed(
          "static equilibrium was lost at load factor " + std::to_string(load_factor_) + ": " + failure, report);
    }
  }
  return report;
}

double StaticSolver::total_energy() const
{
  return sheet_.energy(displacement_);
}

std::map<types::boundary_id, Tensor<1, 2>> StaticSolver::reactions() const
{
  std::map<types::boundary_id, ComponentMask> held;
  for (const PrescribedDisplacement &condition : conditions_)
  {
    ComponentMask mask(2, false);
    for (unsigned int i = 0; i < 2; ++i)
      mask.set(i, condition.components[i]);
    const auto [entry, is_new] = held.try_emplace(condition.boundary, mask);
    if (!is_new)
      entry->second = entry->second | mask;
  }
  return boundary_reactions(sheet_, displacement_, held);
}

DeterminantRange StaticSolver::determinant_range() const
{
  return sheet_.determinant_range(displacement_);
}

std::vector<PointState> StaticSolver::evaluate(const std::vector<Point<2>> &points) const
{
  return sheet_.evaluate(displacement_, points);
}
} // namespace continuum
