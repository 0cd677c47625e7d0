#pragma once

#include "continuum/point_integrand.h"
#include "continuum/sheet.h"

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <array>
#include <list>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace latcon::continuum
{
constexpr unsigned int whole = dealii::numbers::invalid_unsigned_int; ///< in place of a face of a cell, or of its half

/// Derivatives of the scalar shape functions of a cell at the Gauss points of the cell or of one of its faces.
struct ShapeTable
{
  bool is_kept = false; ///< with the cache, as the only one of its kind
  unsigned int n_points = 0;
  unsigned int stride = 0;                   ///< length of a row: number of shape functions, padded with zeros
  std::vector<double> derivatives;           ///< [point][derivative][shape function]
  std::vector<double> JxW;                   ///< weight [m^2] or [m] of each point
  std::vector<dealii::Tensor<1, 2>> normals; ///< of each point of a face, outward
  std::vector<dealii::Tensor<1, 2>> offsets; ///< of each point of a cell from its first vertex [m]
  const double *row(const unsigned int q, const unsigned int derivative) const
  {
    return &derivatives[(q * n_derivatives + derivative) * stride];
  }
};

/// Cache of the shape tables of the cells of a sheet. Parallelograms that differ only by a translation share a table.
/// Edges that differ by less than 1e-11 of their length, an effect of rounding, are considered equal.
class ShapeTables
{
public:
  using Cell = dealii::Triangulation<2>::cell_iterator;

  explicit ShapeTables(const Sheet &sheet);

  /// Returns the table of a cell, valid until the next call of cell().
  const ShapeTable &cell(const Cell &cell);

  /// Returns the table of a face or, if `subface` is not `whole`, of one half of the face; valid until the next call of
  /// face() for the same `side`, 0 or 1.
  const ShapeTable &face(const Cell &cell, unsigned int face, unsigned int subface, unsigned int side);

  /// Returns the FEFaceValues of a face, with quadrature points.
  const dealii::FEFaceValues<2> &face_values(const Cell &cell, unsigned int face);

private:
  using Part = std::pair<unsigned int, unsigned int>; // face, or invalid for the cell, and half of the face, or invalid

  struct Shape
  {
    dealii::Tensor<1, 2> edges[2];
    std::map<Part, ShapeTable> tables;
  };

  Shape *shape_of(const Cell &cell);
  void fill(const dealii::FEValuesBase<2> &values, bool is_face, ShapeTable &table) const;
  const ShapeTable &kept_or_filled(const Cell &cell, const Part &part, ShapeTable &own);

  bool has_gradient_;
  bool is_straight_;
  dealii::FE_Q<2> element_;
  dealii::FEValues<2> cell_values_;
  std::unique_ptr<dealii::FEFaceValues<2>> face_values_;
  std::unique_ptr<dealii::FESubfaceValues<2>> subface_values_;
  std::list<Shape> shapes_; // most recently used first
  std::array<ShapeTable, 3> own_tables_; // where a shape is not shared: of a face of either side, and of a cell
};
} // namespace latcon::continuum
