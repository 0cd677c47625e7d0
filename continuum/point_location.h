#pragma once

#include <deal.II/base/point.h>
#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include <cstddef>
#include <map>
#include <vector>

namespace latcon::continuum
{
/// Points in one cell.
struct PointsInCell
{
  std::vector<std::size_t> indices;          ///< in the list of points
  std::vector<dealii::Point<2>> unit_points; ///< on the reference cell
};

/// Returns the locally owned cells of `mesh` that contain any of the reference points [m], to 1e-8 of a cell: a point
/// on a cell boundary is found in all adjacent cells. Points outside the mesh, or with a coordinate that is not finite,
/// are in none. Local; may throw on one rank alone.
std::map<dealii::Triangulation<2>::active_cell_iterator, PointsInCell>
locate(const dealii::Triangulation<2> &mesh, const dealii::Mapping<2> &mapping,
       const std::vector<dealii::Point<2>> &points);
} // namespace latcon::continuum
