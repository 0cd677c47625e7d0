#include "continuum/point_location.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/grid_tools_cache.h>

#include <cmath>
#include <iterator>
#include <utility>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
using Cell = Triangulation<2>::active_cell_iterator;
} // namespace

std::map<Cell, PointsInCell> locate(const Triangulation<2> &mesh, const Mapping<2> &mapping,
                                    const std::vector<Point<2>> &points)
{
  constexpr double slack = 1e-8; // of a cell, so that a point on a cell boundary is found from both sides
  std::map<Cell, PointsInCell> located;
  const GridTools::Cache<2> cache(mesh, mapping);
  const auto &tree = cache.get_locally_owned_cell_bounding_boxes_rtree();
  if (tree.empty())
    return located;
  const auto bounds = tree.bounds();
  const double margin = slack * boost::geometry::distance(bounds.min_corner(), bounds.max_corner());
  std::vector<std::pair<BoundingBox<2>, Cell>> candidates;
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    if (!std::isfinite(points[p].square())) // deal.II finds such points in cells
      continue;
    const Point<2> shift(margin, margin);
    const BoundingBox<2> box({points[p] - Tensor<1, 2>(shift), points[p] + shift});
    candidates.clear();
    tree.query(boost::geometry::index::intersects(box), std::back_inserter(candidates));
    for (const auto &candidate : candidates)
      try
      {
        const Point<2> unit = mapping.transform_real_to_unit_cell(candidate.second, points[p]);
        if (GeometryInfo<2>::distance_to_unit_cell(unit) > slack)
          continue;
        PointsInCell &there = located[candidate.second];
        there.indices.push_back(p);
        there.unit_points.push_back(unit);
      }
      catch (const Mapping<2>::ExcTransformationFailed &)
      {
        // The point is in the bounding box but far outside the distorted cell.
      }
  }
  return located;
}
} // namespace latcon::continuum
