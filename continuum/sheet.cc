#include "continuum/sheet.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/homogeneous_constraints.h"
#include "continuum/point_location.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
unsigned int checked_degree(const unsigned int degree)
{
  if (degree == 0)
    throw InvalidInput("the degree of elements must be at least 1");
  return degree;
}

// Returns the degree of the mapping: that of the elements if a part of the domain is curved, otherwise 1.
unsigned int mapping_degree(const Sheet::Mesh &mesh, const unsigned int degree)
{
  for (const types::manifold_id id : mesh.get_manifold_ids())
    if (id != numbers::flat_manifold_id)
      return degree;
  return 1;
}
} // namespace

Sheet::Sheet(const Mesh &mesh, const Constitution &constitution, const unsigned int degree,
             BoundaryConditions conditions)
  : mesh_(mesh), constitution_(constitution), conditions_(std::move(conditions)), degree_(checked_degree(degree)),
    normal_stiffness_(constitution.has_gradient() ? constitution.gradient->normal_stiffness() : 0.),
    element_(FE_Q<2>(degree), 2), mapping_(mapping_degree(mesh, degree)), dof_handler_(mesh)
{
  check_input();
  distribute();
}

std::unique_ptr<Sheet> Sheet::clone_on(const Mesh &mesh) const
{
  return std::make_unique<Sheet>(mesh, constitution_, degree_, conditions_);
}

void Sheet::check_input() const
{
  require(mesh_.n_levels() > 0, "the mesh of a sheet has no cells");
  require(!has_gradient() || degree_ >= 2, "a gradient law needs elements of degree 2 or more");
  require(std::isfinite(normal_stiffness_), "a gradient law needs a finite normal stiffness at F = I");
  require(constitution_.penalty >= 0. && std::isfinite(constitution_.penalty),
          "the interior penalty must be finite and not negative");
  const auto ids = mesh_.get_boundary_ids();
  const auto require_edge = [&](const types::boundary_id id)
  {
    require(std::find(ids.begin(), ids.end(), id) != ids.end(),
            "the mesh has no boundary with id " + std::to_string(id));
  };
  const auto require_field = [&](const VectorField &field, const std::string &what)
  { require(field && field->n_components == 2, what + " must be a function with two components"); };
  const auto require_conditions =
    [&](const std::vector<BoundaryField> &conditions, const std::string &what, const bool needs_gradient)
  {
    for (const auto &[boundary, field, components] : conditions)
    {
      require_edge(boundary);
      require_field(field, what);
      require(components.represents_n_components(2) && components.n_selected_components(2) > 0,
              what + " needs a mask of two components, one of them selected");
      require(!needs_gradient || has_gradient(), what + " needs a gradient law that is not zero");
    }
  };
  require_conditions(conditions_.displacements, "a prescribed displacement", false);
  require_conditions(conditions_.normal_gradients, "a prescribed normal gradient", true);
  require_conditions(conditions_.tractions, "a traction", false);
  require_conditions(conditions_.double_tractions, "a double traction", true);
  if (conditions_.body_force)
  {
    require_field(conditions_.body_force->force, "a body force");
    require(conditions_.body_force->length >= 0. && std::isfinite(conditions_.body_force->length),
            "the length of a body force must be at least 0");
  }
  for (const PeriodicPair &pair : conditions_.periodic)
  {
    require_edge(pair.first);
    require_edge(pair.second);
    require(pair.direction < 2, "the direction of a periodic pair must be 0 or 1");
  }
}

void Sheet::distribute()
{
  dof_handler_.distribute_dofs(element_);
  owned_ = dof_handler_.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler_, relevant_);
  AffineConstraints<double> known(relevant_);
  DoFTools::make_hanging_node_constraints(dof_handler_, known);
  for (const PeriodicPair &pair : conditions_.periodic)
    DoFTools::make_periodicity_constraints(dof_handler_, pair.first, pair.second, pair.direction, known);
  known.close();
  conformity_constraints_.copy_from(shared_constraints(known, owned_, relevant_, communicator()));
}

double Sheet::penalty(const double extent) const
{
  return constitution_.penalty * degree_ * (degree_ + 1) / extent * normal_stiffness_;
}

Sheet::Vector Sheet::lift() const
{
  AffineConstraints<double> given(conformity_constraints_.get_local_lines());
  given.merge(conformity_constraints_);
  run_collectively(communicator(),
                   [&]
                   {
                     for (const BoundaryField &condition : conditions_.displacements)
                       VectorTools::interpolate_boundary_values(mapping_, dof_handler_, condition.boundary,
                                                                *condition.field, given, condition.components);
                   });
  Vector nodal = make_owned();
  for (const types::global_dof_index i : owned_)
    if (given.is_constrained(i) && !conformity_constraints_.is_constrained(i))
      nodal(i) = given.get_inhomogeneity(i);
  nodal.compress(VectorOperation::insert);
  conformity_constraints_.distribute(nodal);
  return nodal;
}

std::vector<PointState> Sheet::gradients(const Vector &u, const std::vector<Point<2>> &points) const
{
  // Each cell has one owner, so the mean over the cells that contain a point is independent of the partition.
  constexpr unsigned int n_sums = 15; // u (2), F (4), G (8), number of cells
  std::vector<double> sums(n_sums * points.size(), 0.);
  run_collectively(
    communicator(),
    [&]
    {
      const FEValuesExtractors::Vector displacement(0);
      std::vector<Tensor<1, 2>> values;
      std::vector<Tensor<2, 2>> gradients;
      std::vector<Tensor<3, 2>> hessians;
      for (const auto &[cell, located] : locate(mesh_, mapping_, points))
      {
        FEValues<2> there(mapping_, element_, Quadrature<2>(located.unit_points),
                          update_values | update_gradients | update_hessians);
        there.reinit(typename DoFHandler<2>::active_cell_iterator(&mesh_, cell->level(), cell->index(), &dof_handler_));
        values.resize(located.indices.size());
        gradients.resize(located.indices.size());
        hessians.resize(located.indices.size());
        there[displacement].get_function_values(u, values);
        there[displacement].get_function_gradients(u, gradients);
        there[displacement].get_function_hessians(u, hessians);
        for (std::size_t n = 0; n < located.indices.size(); ++n)
        {
          double *sum = &sums[n_sums * located.indices[n]];
          for (unsigned int i = 0; i < 2; ++i)
          {
            sum[i] += values[n][i];
            for (unsigned int J = 0; J < 2; ++J)
            {
              sum[2 + 2 * i + J] += gradients[n][i][J];
              for (unsigned int K = 0; K < 2; ++K)
                sum[6 + 4 * i + 2 * J + K] += hessians[n][i][J][K];
            }
          }
          sum[n_sums - 1] += 1.;
        }
      }
    });
  dealii::Utilities::MPI::sum(sums, communicator(), sums);

  std::vector<PointState> states(points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const double *sum = &sums[n_sums * p];
    const double count = sum[n_sums - 1];
    if (count == 0.)
    {
      std::ostringstream message;
      message << "the point (" << points[p] << ") m is outside the sheet";
      throw InvalidInput(message.str()); // the sums are the same on every rank, so all throw
    }
    PointState &state = states[p];
    state.X = points[p];
    for (unsigned int i = 0; i < 2; ++i)
    {
      state.displacement[i] = sum[i] / count;
      for (unsigned int J = 0; J < 2; ++J)
      {
        state.F[i][J] = (i == J ? 1. : 0.) + sum[2 + 2 * i + J] / count;
        for (unsigned int K = 0; K < 2; ++K)
          state.G[i][J][K] = sum[6 + 4 * i + 2 * J + K] / count;
      }
    }
  }
  return states;
}

std::vector<PointState> Sheet::evaluate(const Vector &u, const std::vector<Point<2>> &points) const
{
  std::vector<PointState> states = gradients(u, points);
  for (PointState &state : states)
  {
    const GradientResponse W = constitution_.evaluate(state.X, state.F, state.G);
    state.P = W.first_piola;
    state.Q = W.double_stress;
    state.energy_density = W.energy;
  }
  return states;
}

void Sheet::for_each_owned_dof(
  const std::function<void(types::global_dof_index, unsigned int, const Point<2> &)> &visit) const
{
  std::vector<types::global_dof_index> dofs(element_.n_dofs_per_cell());
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      cell->get_dof_indices(dofs);
      for (unsigned int a = 0; a < dofs.size(); ++a)
        if (owned_.is_element(dofs[a]))
          visit(dofs[a], element_.system_to_component_index(a).first,
                mapping_.transform_unit_to_real_cell(cell, element_.unit_support_point(a)));
    }
}

Sheet::Vector Sheet::make_owned() const
{
  return Vector(owned_, communicator());
}

Sheet::Vector Sheet::make_ghosted() const
{
  return Vector(owned_, relevant_, communicator());
}
} // namespace latcon::continuum
