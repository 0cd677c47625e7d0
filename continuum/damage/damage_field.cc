#include "continuum/damage/damage_field.h"

#include "continuum/collective.h"
#include "continuum/element_integrals.h"
#include "continuum/errors.h"
#include "continuum/homogeneous_constraints.h"
#include "continuum/point_location.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
constexpr unsigned int n_vertices = 4; // of a cell

std::array<double, n_vertices> bilinear(const Point<2> &unit_point)
{
  const double x = unit_point[0];
  const double y = unit_point[1];
  return {(1. - x) * (1. - y), x * (1. - y), (1. - x) * y, x * y};
}

// A matrix restricted to the unknowns that are not fixed.
struct FreeBlock
{
  const Sheet::Matrix &matrix;
  const IndexSet &owned;
  const std::vector<char> &fixed;

  void clear_fixed(Sheet::Vector &v) const
  {
    for (std::size_t n = 0; n < fixed.size(); ++n)
      if (fixed[n])
        v(owned.nth_index_in_set(n)) = 0.;
    v.compress(VectorOperation::insert);
  }
  void vmult(Sheet::Vector &to, const Sheet::Vector &from) const
  {
    matrix.vmult(to, from);
    clear_fixed(to);
  }
};
} // namespace

DamageField::DamageField(const Sheet::Mesh &mesh, const DamageLaw &law, const std::set<types::boundary_id> &intact,
                         const std::vector<PeriodicPair> &periodic)
  : law_(law), element_(1), mapping_(1), dof_handler_(mesh)
{
  const auto require = [](const bool holds, const char *rule)
  {
    if (!holds)
      throw InvalidInput(rule);
  };
  require(law.threshold > 0. && std::isfinite(law.threshold), "the threshold of damage must be positive and finite");
  require(law.length > 0. && std::isfinite(law.length), "the length of damage must be positive and finite");
  require(law.residual_stiffness > 0. && law.residual_stiffness < 1., "the residual stiffness must be in (0, 1)");

  dof_handler_.distribute_dofs(element_);
  owned_ = dof_handler_.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler_, relevant_);
  AffineConstraints<double> known(relevant_);
  DoFTools::make_hanging_node_constraints(dof_handler_, known);
  for (const PeriodicPair &pair : periodic)
    DoFTools::make_periodicity_constraints(dof_handler_, pair.first, pair.second, pair.direction, known);
  known.close();
  const MPI_Comm communicator = mesh.get_communicator();
  constraints_.copy_from(shared_constraints(known, owned_, relevant_, communicator));
  intact_ = intact.empty() ? IndexSet(dof_handler_.n_dofs())
                           : DoFTools::extract_boundary_dofs(dof_handler_, ComponentMask(), intact);

  TrilinosWrappers::SparsityPattern pattern(owned_, owned_, constraints_.get_local_lines(), communicator);
  DoFTools::make_sparsity_pattern(dof_handler_, pattern, constraints_, false,
                                  dealii::Utilities::MPI::this_mpi_process(communicator));
  pattern.compress();
  laplace_.reinit(pattern);
  measure_.reinit(owned_, communicator);
  FEValues<2> values(mapping_, element_, QGauss<2>(2), update_values | update_gradients | update_JxW_values);
  FullMatrix<double> local(n_vertices, n_vertices);
  dealii::Vector<double> measure(n_vertices);
  std::vector<types::global_dof_index> dofs(n_vertices);
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      values.reinit(cell);
      local = 0.;
      measure = 0.;
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q)
        for (unsigned int a = 0; a < n_vertices; ++a)
        {
          measure[a] += values.shape_value(a, q) * values.JxW(q);
          for (unsigned int b = 0; b < n_vertices; ++b)
            local(a, b) += values.shape_grad(a, q) * values.shape_grad(b, q) * values.JxW(q);
        }
      cell->get_dof_indices(dofs);
      constraints_.distribute_local_to_global(local, dofs, laplace_);
      constraints_.distribute_local_to_global(measure, dofs, measure_);
    }
  laplace_.compress(VectorOperation::add);
  measure_.compress(VectorOperation::add);
  for (Vector *field : {&damage_, &lower_bound_, &factor_})
    field->reinit(owned_, relevant_, communicator);
  update_factors();
}

void DamageField::set(const std::function<double(const Point<2> &)> &damage)
{
  Vector nodal(owned_, dof_handler_.get_communicator());
  run_collectively(dof_handler_.get_communicator(),
                   [&]
                   {
                     for (const auto &cell : dof_handler_.active_cell_iterators())
                       for (unsigned int v = 0; v < n_vertices && cell->is_locally_owned(); ++v)
                         if (const types::global_dof_index i = cell->vertex_dof_index(v, 0); owned_.is_element(i))
                         {
                           const double value = damage(cell->vertex(v));
                           if (!(value >= 0. && value <= 1.))
                             throw InvalidInput("damage must be in [0, 1]");
                           nodal(i) = value;
                         }
                   });
  nodal.compress(VectorOperation::insert);
  constraints_.distribute(nodal);
  damage_ = nodal;
  accept();
  update_factors();
}

double DamageField::minimize(const Sheet &sheet, const Vector &u, const double load_factor)
{
  if (&sheet.mesh() != &dof_handler_.get_triangulation())
    throw InvalidInput("the damage field and the sheet have different meshes");
  const MPI_Comm communicator = sheet.communicator();
  // Gradient of E by phi over 2 (1 - k): A phi - b, eq. (C.63).
  const Vector energies = nodal_energies(sheet, u, load_factor);
  Vector b = energies;
  b.add(-law_.threshold, measure_);
  Sheet::Matrix A;
  A.copy_from(laplace_);
  A *= 2. * law_.threshold * law_.length * law_.length;
  for (const types::global_dof_index i : owned_)
    if (!constraints_.is_constrained(i))
      A.add(i, i, energies(i));
  A.compress(VectorOperation::add);
  unsigned int n_concave = 0;
  for (const types::global_dof_index i : owned_)
    n_concave += !constraints_.is_constrained(i) && !(A.diag_element(i) > 0.) ? 1 : 0;
  if (dealii::Utilities::MPI::sum(n_concave, communicator) > 0)
    throw NonPhysicalState("the stored energy about a node is so negative that no damage minimises the energy");
  TrilinosWrappers::PreconditionJacobi jacobi;
  jacobi.initialize(A);

  Vector d(owned_, communicator);
  d = damage_;
  Vector lowest(owned_, communicator);
  lowest = lower_bound_;
  Vector descent(owned_, communicator); // b - A d
  Vector step(owned_, communicator);
  Vector magnitude(owned_, communicator); // of the terms of b
  magnitude = energies;
  magnitude.add(law_.threshold, measure_);
  const double accuracy = 1e-13 * magnitude.l2_norm();
  std::vector<char> fixed(owned_.n_elements(), 0);
  bool is_converged = false;
  constexpr unsigned int max_sets = 500;
  for (unsigned int n = 0; n < max_sets && !is_converged; ++n)
  {
    A.vmult(descent, d);
    descent.sadd(-1., b);
    const bool same = select(fixed, [&](const types::global_dof_index i)
                             { return d(i) + descent(i) / A.diag_element(i) <= lowest(i); });
    if (n > 0 && same)
      is_converged = true;
    else
    {
      // Moves the fixed unknowns to their bound, and solves for the others.
      for (std::size_t k = 0; k < fixed.size(); ++k)
        if (const types::global_dof_index i = owned_.nth_index_in_set(k); fixed[k] && !constraints_.is_constrained(i))
          d(i) = lowest(i);
      d.compress(VectorOperation::insert);
      A.vmult(descent, d);
      descent.sadd(-1., b);
      const FreeBlock block{A, owned_, fixed};
      block.clear_fixed(descent);
      step = 0.;
      SolverControl control(10000, accuracy);
      try
      {
        SolverCG<Vector>(control).solve(block, step, descent, jacobi);
      }
      catch (const SolverControl::NoConvergence &)
      {
        throw LinearSolverFailed("conjugate gradients for the damage did not converge");
      }
      d += step;
    }
  }
  if (!is_converged)
    throw LinearSolverFailed("the active set of the damage did not converge");

  constraints_.distribute(d);
  Vector change(owned_, communicator);
  change = damage_;
  change -= d;
  damage_ = d;
  update_factors();
  return change.linfty_norm();
}

// Updates the unknowns that are held: those with test(i), those on intact boundaries, and constrained ones. Returns
// whether none changed on any rank.
template <class Test>
bool DamageField::select(std::vector<char> &fixed, const Test &test) const
{
  unsigned int n_changed = 0;
  for (std::size_t n = 0; n < fixed.size(); ++n)
  {
    const types::global_dof_index i = owned_.nth_index_in_set(n);
    const char is_fixed = constraints_.is_constrained(i) || intact_.is_element(i) || test(i) ? 1 : 0;
    n_changed += is_fixed != fixed[n] ? 1 : 0;
    fixed[n] = is_fixed;
  }
  return dealii::Utilities::MPI::sum(n_changed, dof_handler_.get_communicator()) == 0;
}

// Returns e_a [J/m], eq. (C.62).
DamageField::Vector DamageField::nodal_energies(const Sheet &sheet, const Vector &u, const double load_factor) const
{
  Vector energies(owned_, sheet.communicator());
  std::vector<types::global_dof_index> dofs(n_vertices);
  dealii::Vector<double> shares(n_vertices);
  const DeferredException guarded(
    [&]
    {
      visit_point_energies(sheet, u, load_factor,
                           [&](const auto &cell, const Point<2> &unit_point, const double energy)
                           {
                             const auto shapes = bilinear(unit_point);
                             for (unsigned int v = 0; v < n_vertices; ++v)
                             {
                               shares[v] = shapes[v] * energy;
                               dofs[v] = typename DoFHandler<2>::active_cell_iterator(&dof_handler_.get_triangulation(),
                                                                                      cell->level(), cell->index(),
                                                                                      &dof_handler_)
                                           ->vertex_dof_index(v, 0);
                             }
                             constraints_.distribute_local_to_global(shares, dofs, energies);
                           });
    });
  energies.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());
  return energies;
}

void DamageField::update_factors()
{
  Vector nodal(owned_, dof_handler_.get_communicator());
  for (const types::global_dof_index i : owned_)
    nodal(i) = law_.degradation(damage_(i));
  nodal.compress(VectorOperation::insert);
  constraints_.distribute(nodal); // continuous: at a hanging node the mean of g, not g of the mean
  factor_ = nodal;
}

double DamageField::at(const Triangulation<2>::cell_iterator &cell, const Point<2> &unit_point) const
{
  const typename DoFHandler<2>::active_cell_iterator there(&dof_handler_.get_triangulation(), cell->level(),
                                                           cell->index(), &dof_handler_);
  const auto shapes = bilinear(unit_point);
  double factor = 0.;
  for (unsigned int v = 0; v < n_vertices; ++v)
    factor += shapes[v] * factor_(there->vertex_dof_index(v, 0));
  return factor;
}

double DamageField::fracture_energy() const
{
  Vector d(owned_, dof_handler_.get_communicator());
  d = damage_;
  for (const types::global_dof_index i : owned_)
    if (constraints_.is_constrained(i))
      d(i) = 0.; // its share is condensed into the others
  d.compress(VectorOperation::insert);
  Vector product(owned_, dof_handler_.get_communicator());
  laplace_.vmult(product, d);
  return 2. * (1. - law_.residual_stiffness) * law_.threshold *
         (measure_ * d + law_.length * law_.length * (d * product));
}

double DamageField::largest() const
{
  return damage_.max();
}

std::vector<double> DamageField::evaluate(const std::vector<Point<2>> &points) const
{
  std::vector<double> sums(2 * points.size(), 0.);
  run_collectively(dof_handler_.get_communicator(),
                   [&]
                   {
                     for (const auto &[cell, located] : locate(dof_handler_.get_triangulation(), mapping_, points))
                     {
                       const typename DoFHandler<2>::active_cell_iterator there(
                         &dof_handler_.get_triangulation(), cell->level(), cell->index(), &dof_handler_);
                       for (std::size_t n = 0; n < located.indices.size(); ++n)
                       {
                         const auto shapes = bilinear(located.unit_points[n]);
                         double *sum = &sums[2 * located.indices[n]];
                         for (unsigned int v = 0; v < n_vertices; ++v)
                           sum[0] += shapes[v] * damage_(there->vertex_dof_index(v, 0));
                         sum[1] += 1.;
                       }
                     }
                   });
  dealii::Utilities::MPI::sum(sums, dof_handler_.get_communicator(), sums);
  std::vector<double> values;
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    if (sums[2 * p + 1] == 0.)
      throw InvalidInput("a point at which damage is evaluated is outside the sheet");
    values.push_back(sums[2 * p] / sums[2 * p + 1]);
  }
  return values;
}
} // namespace latcon::continuum
