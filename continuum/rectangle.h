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

/// The reference rectangle [0, length] x [-height/2, height/2] in metres, cut into cells_x times cells_y equal cells.
struct Rectangle
{
  double length;           ///< [m] > 0
  double height;           ///< [m] > 0
  unsigned int cells_x;    ///< >= 1
  unsigned int cells_y;    ///< >= 1
  bool periodic_x = false; ///< the right edge is the left one; at least 2 cells across
  bool periodic_y = false; ///< the top edge is the bottom one; at least 2 cells across
};

/// Meshes `rectangle` into the empty `mesh`, with the boundary ids of continuum::edge. Collective. As many halvings as
/// cells_x and cells_y share are made by refinement, the rest is the coarse mesh, which every rank holds whole.
/// A periodic mesh still has its four edges; what follows from it for the displacement is for PeriodicPair to say.
/// Throws InvalidInput for a size that is not positive and finite, or too few cells.
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle);
} // namespace latcon::continuum
