#pragma once

#include <deal.II/distributed/tria.h>

namespace latcon::continuum
{
/// Boundary ids of a Rectangle.
namespace edge
{
constexpr dealii::types::boundary_id left = 0;   ///< smallest X
constexpr dealii::types::boundary_id right = 1;  ///< largest X
constexpr dealii::types::boundary_id bottom = 2; ///< smallest Y
constexpr dealii::types::boundary_id top = 3;    ///< largest Y
} // namespace edge

/// Reference rectangle [0, length] x [-height/2, height/2] [m], divided into cells_x times cells_y equal cells.
struct Rectangle
{
  double length;           ///< [m] > 0
  double height;           ///< [m] > 0
  unsigned int cells_x;    ///< >= 1
  unsigned int cells_y;    ///< >= 1
  bool periodic_x = false; ///< identifies the right edge with the left one; needs at least 2 cells across
  bool periodic_y = false; ///< identifies the top edge with the bottom one; needs at least 2 cells across
};

/// Generates the mesh of `rectangle` in the empty `mesh`, with the boundary ids of continuum::edge. Collective. Common
/// factors of two of cells_x and cells_y become refinements of a coarse mesh, which is replicated on every rank. A
/// periodic mesh still has its four edges; PeriodicPair constrains the displacement. Throws InvalidInput for a size
/// that is not positive and finite, or too few cells.
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle);
} // namespace latcon::continuum
