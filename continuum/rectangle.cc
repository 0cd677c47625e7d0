#include "continuum/rectangle.h"

#include "continuum/errors.h"

#include <deal.II/grid/grid_generator.h>

#include <cmath>

namespace continuum
{
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle)
{
  const auto is_size = [](const double size) { return size > 0. && std::isfinite(size); };
  if (!is_size(rectangle.length) || !is_size(rectangle.height))
    throw InvalidInput("a rectangle needs a positive, finite length and height");
  if (rectangle.cells_x == 0 || rectangle.cells_y == 0)
    throw InvalidInput("a rectangle needs at least one cell in each direction");

  // Refined rather than coarse cells: they are distributed, and they form the levels of a multigrid hierarchy.
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
  // Colourised, the generator numbers the edges as continuum::edge does.
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {coarse_x, coarse_y}, lower_left, upper_right, true);
  mesh.refine_global(halvings);
}
} // namespace continuum
