#include "continuum/reactions.h"

#include "continuum/collective.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/filtered_iterator.h>

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

std::map<types::boundary_id, Tensor<1, 2>> boundary_reactions(const Sheet &sheet, const Sheet::Vector &u,
                                                              const Sheet::Vector &residual)
{
  std::map<types::boundary_id, HeldBoundary> boundaries;
  for (const BoundaryField &condition : sheet.conditions().displacements)
  {
    const IndexSet held =
      DoFTools::extract_boundary_dofs(sheet.dof_handler(), condition.components, {condition.boundary});
    const HeldBoundary none{IndexSet(held.size()), sheet.make_owned(), {}};
    boundaries.try_emplace(condition.boundary, none).first->second.dofs.add_indices(held);
  }
  const DeferredException guarded(
    [&]
    {
      const auto &element = sheet.element();
      FEFaceValues<2> values(sheet.mapping(), element, QGauss<1>(sheet.degree() + 1),
                             update_values | update_gradients | update_hessians | update_normal_vectors |
                               update_JxW_values | update_quadrature_points);
      const FEValuesExtractors::Vector displacement(0);
      std::vector<Tensor<2, 2>> F(values.n_quadrature_points);
      std::vector<Tensor<3, 2>> G(values.n_quadrature_points);
      std::vector<types::global_dof_index> dofs(element.n_dofs_per_cell());
      Vector<double> forces(element.n_dofs_per_cell());
      const auto add = [&](const auto &cell, const unsigned int face, Sheet::Vector &tractions)
      {
        values.reinit(cell, face);
        values[displacement].get_function_gradients(u, F);
        values[displacement].get_function_hessians(u, G);
        forces = 0.;
        for (unsigned int q = 0; q < F.size(); ++q)
        {
          for (unsigned int i = 0; i < 2; ++i)
            F[q][i][i] += 1.;
          const Tensor<1, 2> traction =
            sheet.constitution().evaluate(values.quadrature_point(q), F[q], G[q]).first_piola *
            values.normal_vector(q) * values.JxW(q);
          for (unsigned int a = 0; a < dofs.size(); ++a)
            forces[a] += traction[element.system_to_component_index(a).first] * values.shape_value(a, q);
        }
        cell->get_dof_indices(dofs);
        sheet.conformity_constraints().distribute_local_to_global(forces, dofs, tractions);
      };
      for (const auto &cell : sheet.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
        for (const unsigned int face : cell->face_indices())
          if (const auto held = boundaries.find(cell->face(face)->boundary_id()); held != boundaries.end())
            add(cell, face, held->second.tractions);
    });
  for (auto &[id, boundary] : boundaries)
    boundary.tractions.compress(VectorOperation::add);
  guarded.rethrow_collectively(sheet.communicator());

  const std::vector<IndexSet> owned = DoFTools::locally_owned_dofs_per_component(sheet.dof_handler());
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
    forces[id] = dealii::Utilities::MPI::sum(boundary.force, sheet.communicator());
  return forces;
}
} // namespace latcon::continuum
