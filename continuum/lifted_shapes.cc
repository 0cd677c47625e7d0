#include "continuum/lifted_shapes.h"

#include <deal.II/base/qprojector.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/grid/filtered_iterator.h>

#include <algorithm>
#include <cmath>
#include <tuple>

using namespace dealii;

namespace latcon::continuum
{
std::vector<LiftedFace> lifted_faces(const Sheet &sheet, const LiftedFace::Cell &cell)
{
  std::vector<LiftedFace> faces;
  for (const unsigned int face : cell->face_indices())
  {
    const bool periodic = cell->has_periodic_neighbor(face);
    if (cell->at_boundary(face) && !periodic)
    {
      const auto &conditions = sheet.conditions().normal_gradients;
      const auto condition = std::find_if(conditions.begin(), conditions.end(), [&](const auto &candidate)
                                          { return candidate.boundary == cell->face(face)->boundary_id(); });
      if (condition != conditions.end())
        faces.push_back({face, whole, {}, 0, whole, &*condition});
      continue;
    }
    const auto neighbor = cell->neighbor_or_periodic_neighbor(face);
    if (periodic ? cell->periodic_neighbor_is_coarser(face) : cell->neighbor_is_coarser(face))
    {
      const auto [neighbor_face, half] = periodic ? cell->periodic_neighbor_of_coarser_periodic_neighbor(face)
                                                  : cell->neighbor_of_coarser_neighbor(face);
      faces.push_back({face, whole, neighbor, neighbor_face, half});
      continue;
    }
    const unsigned int neighbor_face = periodic ? cell->periodic_neighbor_face_no(face) : cell->neighbor_face_no(face);
    if (!neighbor->has_children())
      faces.push_back({face, whole, neighbor, neighbor_face});
    for (unsigned int half = 0; half < 2 && neighbor->has_children(); ++half)
      faces.push_back(
        {face, half,
         periodic ? cell->periodic_neighbor_child_on_subface(face, half) : cell->neighbor_child_on_subface(face, half),
         neighbor_face});
  }
  return faces;
}

void for_each_coupling(const Sheet &sheet, const bool has_gradient,
                       const std::function<void(const std::vector<types::global_dof_index> &)> &couple)
{
  std::vector<types::global_dof_index> dofs(sheet.element().n_dofs_per_cell()), of_neighbor(dofs.size());
  for (const auto &cell : sheet.dof_handler().active_cell_iterators() | IteratorFilters::LocallyOwnedCell())
  {
    cell->get_dof_indices(dofs);
    couple(dofs);
    for (const LiftedFace &face : has_gradient ? lifted_faces(sheet, cell) : std::vector<LiftedFace>())
      if (face.condition == nullptr && (cell < face.neighbor || !face.neighbor->is_locally_owned()))
      {
        face.neighbor->get_dof_indices(of_neighbor);
        std::vector<types::global_dof_index> of_both = dofs;
        of_both.insert(of_both.end(), of_neighbor.begin(), of_neighbor.end());
        couple(of_both);
      }
  }
}

LiftedShapes::LiftedShapes(const unsigned int degree)
{
  const QGauss<1> quadrature(degree + 1);
  const QGauss<2> cell(degree + 1);
  const FE_DGQLegendre<2> modes(degree - 1); // orthonormal polynomials on the unit cell
  const auto values_at = [&](const Quadrature<2> &points)
  {
    FullMatrix<double> of_modes(points.size(), modes.n_dofs_per_cell());
    for (unsigned int p = 0; p < of_modes.m(); ++p)
      for (unsigned int m = 0; m < of_modes.n(); ++m)
        of_modes(p, m) = modes.shape_value(m, points.point(p));
    return of_modes;
  };
  const FullMatrix<double> at_cell = values_at(cell);
  for (unsigned int face = 0; face < 4; ++face)
    for (unsigned int part = 0; part < 3; ++part)
    {
      const Quadrature<2> points =
        part == 0 ? QProjector<2>::project_to_face(ReferenceCells::Quadrilateral, quadrature, face)
                  : QProjector<2>::project_to_subface(ReferenceCells::Quadrilateral, quadrature, face, part - 1);
      const FullMatrix<double> at_face = values_at(points);
      FullMatrix<double> &values = faces_[face][part].polynomial;
      values.reinit(cell.size(), points.size());
      for (unsigned int q = 0; q < values.m(); ++q)
        for (unsigned int f = 0; f < values.n(); ++f)
          for (unsigned int m = 0; m < modes.n_dofs_per_cell(); ++m)
            values(q, f) += cell.weight(q) * at_cell(q, m) * at_face(f, m);
    }
}

ComponentDerivatives LiftedShapes::weights(const unsigned int q, const unsigned int f) const
{
  const double weight = -now_->factor * now_->face->JxW[f] / now_->cell->JxW[q] * now_->polynomial(q, f);
  const Tensor<1, 2> &N = now_->face->normals[f];
  return {0., 0., weight * N[0] * N[0], weight * N[1] * N[1], weight * N[0] * N[1]};
}

void LiftedShapes::reinit(const ShapeTable &cell, const ShapeTable &cell_face, const ShapeTable *neighbor_face,
                          const LiftedFace &at, const std::size_t n_faces,
                          const std::vector<unsigned int> &neighbor_nodes, const unsigned int stride)
{
  const unsigned int part = at.subface == whole ? 0 : at.subface + 1;
  const double factor = (neighbor_face != nullptr ? 0.5 : 1.) * static_cast<double>(n_faces);
  Face &now = faces_[at.face][part];
  now_ = &now;
  const bool is_kept = cell.is_kept && cell_face.is_kept && (neighbor_face == nullptr || neighbor_face->is_kept);
  if (is_kept && std::tie(now.cell, now.face, now.neighbor_face, now.factor, now.neighbor_nodes, now.stride) ==
                   std::make_tuple(&cell, &cell_face, neighbor_face, factor, std::cref(neighbor_nodes), stride))
    return;
  now.cell = &cell;
  now.face = &cell_face;
  now.neighbor_face = neighbor_face;
  now.factor = factor;
  now.neighbor_nodes = neighbor_nodes;
  now.stride = stride;

  now.jump.assign(cell_face.n_points * stride, 0.);
  for (unsigned int f = 0; f < cell_face.n_points; ++f)
    for (unsigned int J = 0; J < 2; ++J)
    {
      const double N = cell_face.normals[f][J];
      double *jump = &now.jump[f * stride];
      for (unsigned int a = 0; a < cell_face.stride; ++a)
        jump[a] += N * cell_face.row(f, J)[a];
      for (std::size_t a = 0; a < neighbor_nodes.size(); ++a)
        jump[neighbor_nodes[a]] -= N * neighbor_face->row(f, J)[a];
    }

  now.basis.assign(cell.n_points * n_derivatives * stride, 0.);
  for (unsigned int q = 0; q < cell.n_points; ++q)
  {
    double *rows = &now.basis[q * n_derivatives * stride];
    for (unsigned int c = 0; c < n_derivatives; ++c)
      std::copy(cell.row(q, c), cell.row(q, c) + cell.stride, rows + c * stride);
    for (unsigned int f = 0; f < cell_face.n_points; ++f)
    {
      // On straight faces most polynomials vanish at most points.
      constexpr double rounding = 1e-13;
      if (std::abs(now.polynomial(q, f)) < rounding)
        continue;
      const ComponentDerivatives weight = weights(q, f);
      for (unsigned int c = n_first; c < n_derivatives; ++c)
        if (weight[c] != 0.)
          for (unsigned int a = 0; a < stride; ++a)
            rows[c * stride + a] += weight[c] * jump(f)[a];
    }
  }
}

ComponentDerivatives LiftedShapes::lift(const unsigned int q, const std::vector<double> &values) const
{
  ComponentDerivatives sum{};
  for (std::size_t f = 0; f < values.size(); ++f)
  {
    const ComponentDerivatives weight = weights(q, f);
    for (unsigned int c = n_first; c < n_derivatives; ++c)
      sum[c] += weight[c] * values[f];
  }
  return sum;
}
} // namespace latcon::continuum
