#include "continuum/shape_tables.h"

#include "continuum/vector_kernels.h"

#include <deal.II/base/quadrature_lib.h>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// More shapes than an adaptive mesh has; bounds the cost of an unsuccessful search.
constexpr std::size_t max_shapes = 32;
} // namespace

ShapeTables::ShapeTables(const Sheet &sheet)
  : has_gradient_(sheet.has_gradient()), is_straight_(sheet.mapping().get_degree() == 1), element_(sheet.degree()),
    cell_values_(sheet.mapping(), element_, QGauss<2>(sheet.degree() + 1),
                 update_JxW_values | update_quadrature_points | update_gradients |
                   (has_gradient_ ? update_hessians : update_default))
{
  if (!has_gradient_)
    return;
  const UpdateFlags flags =
    update_gradients | update_hessians | update_JxW_values | update_normal_vectors | update_quadrature_points;
  const QGauss<1> quadrature(sheet.degree() + 1);
  face_values_ = std::make_unique<FEFaceValues<2>>(sheet.mapping(), element_, quadrature, flags);
  subface_values_ = std::make_unique<FESubfaceValues<2>>(sheet.mapping(), element_, quadrature, flags);
}

ShapeTables::Shape *ShapeTables::shape_of(const Cell &cell)
{
  if (!is_straight_)
    return nullptr;
  const Tensor<1, 2> edges[2] = {cell->vertex(1) - cell->vertex(0), cell->vertex(2) - cell->vertex(0)};
  const double rounding = 1e-22 * (edges[0].norm_square() + edges[1].norm_square());
  if ((cell->vertex(3) - cell->vertex(0) - edges[0] - edges[1]).norm_square() > rounding)
    return nullptr;
  for (auto shape = shapes_.begin(); shape != shapes_.end(); ++shape)
    if ((shape->edges[0] - edges[0]).norm_square() <= rounding &&
        (shape->edges[1] - edges[1]).norm_square() <= rounding)
    {
      shapes_.splice(shapes_.begin(), shapes_, shape);
      return &shapes_.front();
    }
  if (shapes_.size() == max_shapes)
    return nullptr;
  shapes_.emplace_front();
  shapes_.front().edges[0] = edges[0];
  shapes_.front().edges[1] = edges[1];
  return &shapes_.front();
}

void ShapeTables::fill(const FEValuesBase<2> &values, const bool is_face, ShapeTable &table) const
{
  const unsigned int n = element_.n_dofs_per_cell();
  table.n_points = values.n_quadrature_points;
  table.stride = padded_size(n);
  table.derivatives.assign(table.n_points * n_derivatives * table.stride, 0.);
  table.JxW = values.get_JxW_values();
  if (is_face)
    table.normals = values.get_normal_vectors();
  table.offsets.clear();
  for (unsigned int q = 0; q < table.n_points && !is_face; ++q)
    table.offsets.push_back(values.quadrature_point(q) - values.get_cell()->vertex(0));
  for (unsigned int q = 0; q < table.n_points; ++q)
    for (unsigned int a = 0; a < n; ++a)
    {
      double *derivative = &table.derivatives[q * n_derivatives * table.stride + a];
      const Tensor<1, 2> &gradient = values.shape_grad(a, q);
      derivative[0] = gradient[0];
      derivative[table.stride] = gradient[1];
      if (!has_gradient_)
        continue;
      const Tensor<2, 2> &hessian = values.shape_hessian(a, q);
      derivative[2 * table.stride] = hessian[0][0];
      derivative[3 * table.stride] = hessian[1][1];
      derivative[4 * table.stride] = hessian[0][1];
    }
}

const ShapeTable &ShapeTables::cell(const Cell &cell)
{
  return kept_or_filled(cell, {whole, whole}, own_tables_[2]);
}

const ShapeTable &ShapeTables::face(const Cell &cell, const unsigned int face, const unsigned int subface,
                                    const unsigned int side)
{
  return kept_or_filled(cell, {face, subface}, own_tables_[side]);
}

const ShapeTable &ShapeTables::kept_or_filled(const Cell &cell, const Part &part, ShapeTable &own)
{
  Shape *shape = shape_of(cell);
  ShapeTable &table = shape ? shape->tables[part] : own;
  table.is_kept = shape != nullptr;
  if (shape && table.n_points > 0)
    return table;
  const auto &[face, subface] = part;
  if (face == whole)
  {
    cell_values_.reinit(cell);
    fill(cell_values_, false, table);
  }
  else if (subface == whole)
    fill(face_values(cell, face), true, table);
  else
  {
    subface_values_->reinit(cell, face, subface);
    fill(*subface_values_, true, table);
  }
  return table;
}

const FEFaceValues<2> &ShapeTables::face_values(const Cell &cell, const unsigned int face)
{
  face_values_->reinit(cell, face);
  return *face_values_;
}
} // namespace latcon::continuum
