#pragma once

#include "continuum/shape_tables.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <vector>

namespace latcon::continuum
{
/// Face or half of a face of a cell across which the normal derivative of u may jump, or differ from a prescribed one.
struct LiftedFace
{
  using Cell = dealii::DoFHandler<2>::active_cell_iterator;

  unsigned int face;
  unsigned int subface; ///< half of the face, numbers::invalid_unsigned_int: all of it
  Cell neighbor;        ///< invalid on the boundary
  unsigned int neighbor_face = 0;
  unsigned int neighbor_subface = dealii::numbers::invalid_unsigned_int;
  const BoundaryField *condition = nullptr; ///< on the boundary
};

/// Returns the faces of a cell that are lifted: those to other cells, halves where the neighbors are finer, and those
/// with a prescribed normal gradient. Where several conditions are given, the first in the list applies.
std::vector<LiftedFace> lifted_faces(const Sheet &sheet, const LiftedFace::Cell &cell);

/// Calls `couple` with the unknowns of each cell that this rank owns and, with a gradient energy, with those of each
/// such cell and a neighbor, where they may repeat. (DoFTools::make_flux_sparsity_pattern() leaves out the second of
/// two finer neighbors across a period.)
void for_each_coupling(const Sheet &sheet, bool has_gradient,
                       const std::function<void(const std::vector<dealii::types::global_dof_index> &)> &couple);

/// Derivatives of the shape functions of a cell and of its neighbor across one face, at the Gauss points of the cell,
/// with the lifted second gradient of eqs. (C.28) and (C.59). The nodes of the neighbor follow those of the cell,
/// unless they are shared.
class LiftedShapes
{
public:
  explicit LiftedShapes(unsigned int degree);

  /// Computes the derivatives for a face, of which the cell has `n_faces`, unless the last cell with this face had the
  /// same tables. `neighbor_face` is nullptr on the boundary, and otherwise `neighbor_nodes` are the numbers of the
  /// neighbor's nodes among `stride` or fewer.
  void reinit(const ShapeTable &cell, const ShapeTable &cell_face, const ShapeTable *neighbor_face, const LiftedFace &at,
              std::size_t n_faces, const std::vector<unsigned int> &neighbor_nodes, unsigned int stride);

  /// Rows of the basis at point q of the cell (see element_kernels.h).
  const double *basis(const unsigned int q) const { return &now_->basis[q * n_derivatives * now_->stride]; }

  /// Row of the jump z of the normal derivative at point f of the face, value on the cell minus that on the neighbor.
  const double *jump(const unsigned int f) const { return &now_->jump[f * now_->stride]; }

  /// Returns the sums over f of `values[f]`, a normal gradient, lifted at point q of the cell: what a unit jump adds to
  /// the second derivatives.
  ComponentDerivatives lift(unsigned int q, const std::vector<double> &values) const;

private:
  // Derivatives for a face, and what they depend on.
  struct Face
  {
    dealii::FullMatrix<double> polynomial; // (point of cell, point of face)
    const ShapeTable *cell = nullptr;
    const ShapeTable *face = nullptr;
    const ShapeTable *neighbor_face = nullptr;
    double factor = 0.;
    std::vector<unsigned int> neighbor_nodes;
    unsigned int stride = 0;
    std::vector<double> basis; // [point of the cell][derivative][node]
    std::vector<double> jump;  // [point of the face][node]
  };

  // Share of the second derivatives at point q that a unit jump at point f of the face adds.
  ComponentDerivatives weights(unsigned int q, unsigned int f) const;

  Face faces_[4][3]; // [face][all, first half, second half]
  const Face *now_ = nullptr;
};
} // namespace latcon::continuum
