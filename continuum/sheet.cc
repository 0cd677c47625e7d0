#include "continuum/sheet.h"

#include "continuum/collective.h"
#include "continuum/element_integrals.h"
#include "continuum/errors.h"
#include "continuum/lifted_shapes.h"
#include "continuum/single_precision_matrix.h"
#include "support/text_wrap.h"

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/filtered_iterator.h>
#include <deal.II/grid/grid_tools_cache.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/numerics/vector_tools_boundary.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
unsigned int checked_degree(const unsigned int degree)
{
  require(degree > 0, "the degree of elements must be at least 1");
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

// Points in one cell: numbers in a list, and positions on the reference cell.
struct PointsInCell
{
  std::vector<std::size_t> indices;
  std::vector<Point<2>> unit_points;
};
using Cell = Triangulation<2>::active_cell_iterator;

// Returns the locally owned cells that contain any of the points [m], to 1e-8 of a cell: a point on a cell boundary is
// found in all adjacent cells. Points outside the mesh, or with a coordinate that is not finite, are in none.
std::map<Cell, PointsInCell> locate(const Sheet &sheet, const std::vector<Point<2>> &points)
{
  constexpr double slack = 1e-8; // of a cell
  std::map<Cell, PointsInCell> located;
  const GridTools::Cache<2> cache(sheet.mesh(), sheet.mapping());
  const auto &tree = cache.get_locally_owned_cell_bounding_boxes_rtree();
  const auto bounds = tree.bounds();
  const double margin = tree.empty() ? 0. : slack * boost::geometry::distance(bounds.min_corner(), bounds.max_corner());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    if (!std::isfinite(points[p].square())) // deal.II finds such points in cells
      continue;
    BoundingBox<2> box({points[p], points[p]});
    box.extend(margin);
    for (auto near = tree.qbegin(boost::geometry::index::intersects(box)); near != tree.qend(); ++near)
      try
      {
        const Point<2> unit = sheet.mapping().transform_real_to_unit_cell(near->second, points[p]);
        if (GeometryInfo<2>::distance_to_unit_cell(unit) > slack)
          continue;
        located[near->second].indices.push_back(p);
        located[near->second].unit_points.push_back(unit);
      }
      catch (const Mapping<2>::ExcTransformationFailed &)
      {
        // The point is in the bounding box but far outside the distorted cell.
      }
  }
  return located;
}

// Returns the constraints of every relevant unknown as known to its owner. Those `known` to this rank lack those on the
// far side of its ghost cells, to which operators with face terms couple.
AffineConstraints<double> shared_constraints(const AffineConstraints<double> &known, const Sheet &sheet)
{
  // A rank may know the constraints of an unknown of another rank in part.
  AffineConstraints<double> shared(sheet.relevant());
  for (const auto &line : known.get_lines())
    if (sheet.owned().is_element(line.index))
    {
      shared.add_line(line.index);
      shared.add_entries(line.index, line.entries);
    }
  shared.make_consistent_in_parallel(sheet.owned(), sheet.relevant(), sheet.communicator());
  IndexSet storable = sheet.relevant();
  for (const auto &line : shared.get_lines())
    for (const auto &entry : line.entries)
      if (!sheet.relevant().is_element(entry.first))
        storable.add_index(entry.first);
  AffineConstraints<double> constraints(storable);
  constraints.merge(shared, AffineConstraints<double>::no_conflicts_allowed, true);
  constraints.close();
  return constraints;
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
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto &cell : mesh.active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
    smallest = std::min(smallest, cell->minimum_vertex_distance());
  smallest_cell_ = dealii::Utilities::MPI::min(smallest, communicator());
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
  conformity_constraints_.copy_from(shared_constraints(known, *this));
  apply_conditions();
}

void Sheet::apply_conditions()
{
  AffineConstraints<double> known(relevant_);
  known.merge(conformity_constraints_, AffineConstraints<double>::no_conflicts_allowed, true);
  for (const BoundaryField &condition : conditions_.displacements)
    DoFTools::make_zero_boundary_constraints(dof_handler_, condition.boundary, known, condition.components);
  known.close(); // before sending: the receiver may not have the constraints of intermediate degrees of freedom
  homogeneous_constraints_.copy_from(shared_constraints(known, *this));
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
      for (const auto &[cell, located] : locate(*this, points))
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
          const auto add = [&sum](const auto &tensor)
          { std::for_each(tensor.begin_raw(), tensor.end_raw(), [&sum](const double x) { *sum++ += x; }); };
          add(values[n]);
          add(gradients[n]);
          add(hessians[n]);
          *sum += 1.;
        }
      }
    });
  dealii::Utilities::MPI::sum(sums, communicator(), sums);

  std::vector<PointState> states(points.size());
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const double *sum = &sums[n_sums * p];
    const double count = sum[n_sums - 1];
    // The sums are the same on every rank, so all throw.
    if (count == 0.)
      throw InvalidInput(support::text_of("the point (", points[p], ") m is outside the sheet"));
    PointState &state = states[p];
    state.X = points[p];
    const auto take = [&](auto &tensor)
    { std::generate(tensor.begin_raw(), tensor.end_raw(), [&] { return *sum++ / count; }); };
    take(state.displacement);
    take(state.F);
    take(state.G);
    for (unsigned int i = 0; i < 2; ++i)
      state.F[i][i] += 1.;
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

Sheet::Vector Sheet::with_ghosts(const Vector &x) const
{
  Vector copy = make_ghosted();
  copy = x;
  return copy;
}

Sheet::Vector Sheet::without_ghosts(const Vector &x) const
{
  Vector copy = make_owned();
  copy = x;
  return copy;
}

double Sheet::energy(const Vector &u, const double load_factor) const
{
  return integral(*this, u, energy_densities(*this, load_factor, Order::value));
}

double Sheet::residual(const Vector &u, Vector &r, Vector &magnitude, const double load_factor) const
{
  r = 0.;
  magnitude = 0.;
  return add_forces(*this, u, energy_densities(*this, load_factor, Order::first), r, &magnitude);
}

template <class AnyMatrix>
void Sheet::tangent(const Vector &u, const AffineConstraints<double> &constraints, AnyMatrix &K,
                    const double load_factor, const Vector *lift, Vector *stiffness_times_lift) const
{
  K = 0.;
  if (lift != nullptr)
    *stiffness_times_lift = 0.;
  add_tangent(*this, u, energy_densities(*this, load_factor, Order::second), constraints, K, lift,
              stiffness_times_lift);
}

template void Sheet::tangent(const Vector &, const AffineConstraints<double> &, Matrix &, double, const Vector *,
                             Vector *) const;
template void Sheet::tangent(const Vector &, const AffineConstraints<double> &, SinglePrecisionMatrix &, double,
                             const Vector *, Vector *) const;

void Sheet::make_matrix(const AffineConstraints<double> &constraints, Matrix &matrix, const bool is_mass) const
{
  TrilinosWrappers::SparsityPattern pattern(owned_, owned_, constraints.get_local_lines(), communicator());
  for_each_coupling(*this, has_gradient() && !is_mass,
                    [&](const std::vector<types::global_dof_index> &dofs)
                    { constraints.add_entries_local_to_global(dofs, pattern, false); });
  pattern.compress();
  matrix.reinit(pattern);
}

DeterminantRange Sheet::determinant_range(const Vector &u) const
{
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  PointForces at_points;
  at_points.local = [&](const CellPoint &point, PointIntegrand &)
  {
    const double J = determinant(deformation_gradient(point.u));
    smallest = std::min(smallest, J);
    largest = std::max(largest, J);
  };
  integrate(*this, u, at_points, Order::value, [](const Contribution &) {});
  return {dealii::Utilities::MPI::min(smallest, communicator()), dealii::Utilities::MPI::max(largest, communicator())};
}
} // namespace latcon::continuum
