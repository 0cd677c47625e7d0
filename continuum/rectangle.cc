#include "continuum/rectangle.h"

#include "continuum/errors.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>
#include <vector>

namespace latcon::continuum
{
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle)
{
  const auto is_size = [](const double size) { return size > 0. && std::isfinite(size); };
  if (!is_size(rectangle.length) || !is_size(rectangle.height))
    throw InvalidInput("the length and height of a rectangle must be positive and finite");
  if (rectangle.cells_x == 0 || rectangle.cells_y == 0)
    throw InvalidInput("a rectangle needs at least one cell in each direction");
  // With a single cell across, the cell would be its own neighbour.
  if ((rectangle.periodic_x && rectangle.cells_x < 2) || (rectangle.periodic_y && rectangle.cells_y < 2))
    throw InvalidInput("a periodic rectangle needs at least two cells across");

  // Prefer refined to coarse cells: refined cells are distributed and form the levels of multigrid.
  unsigned int halvings = 0;
  unsigned int coarse_x = rectangle.cells_x;
  unsigned int coarse_y = rectangle.cells_y;
  while (coarse_x % 2 == 0 && coarse_y % 2 == 0)
  {
    coarse_x /= 2;
    coarse_y /= 2;
    ++halvings;
  }
  const dealii::Point<2> lower_left(0., -0.5 * rectangle.height);
  const dealii::Point<2> upper_right(rectangle.length, 0.5 * rectangle.height);
  // With `colorize` the generator numbers the edges as continuum::edge does.
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {coarse_x, coarse_y}, lower_left, upper_right, true);
  std::vector<dealii::GridTools::PeriodicFacePair<dealii::parallel::distributed::Triangulation<2>::cell_iterator>>
    pairs;
  if (rectangle.periodic_x)
    dealii::GridTools::collect_periodic_faces(mesh, edge::left, edge::right, 0, pairs);
  if (rectangle.periodic_y)
    dealii::GridTools::collect_periodic_faces(mesh, edge::bottom, edge::top, 1, pairs);
  if (!pairs.empty())
    mesh.add_periodicity(pairs);
  mesh.refine_global(halvings);
}
} // namespace latcon::continuum
