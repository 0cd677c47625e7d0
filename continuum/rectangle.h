#pragma once

#include <deal.II/distributed/tria.h>

namespace continuum
{
/// Boundary ids of a Rectangle.
namespace edge
{
constexpr dealii::types::boundary_id left = 0;
constexpr dealii::types::boundary_id right = 1;
constexpr dealii::types::boundary_id bottom = 2;
constexpr dealii::types::boundary_id top = 3;
} // namespace edge

/// The reference rectangle [0, length] x [-height/2, height/2] in metres, cut into cells_x times cells_y equal cells.
struct Rectangle
{
  double length;        ///< [m] > 0
  double height;        ///< [m] > 0
  unsigned int cells_x; ///< >= 1
  unsigned int cells_y; ///< >= 1
};

/// Meshes `rectangle` into the empty `mesh`, with the boundary ids of continuum::edge. Collective. As many halvings as
/// cells_x and cells_y share are made by refinement, the rest is the coarse mesh, which every rank holds whole.
/// Throws InvalidInput for a size that is not positive and finite, or no cells.
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle);
} // namespace continuum
