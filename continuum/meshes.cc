#include "continuum/meshes.h"

#include "continuum/errors.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
constexpr types::manifold_id rim = 1;

void require_size(const double length, const double height)
{
  require(length > 0. && height > 0. && std::isfinite(length) && std::isfinite(height),
          "the length and height of a rectangle must be positive and finite");
}

// Returns the number of parts of about `size` between `from` and `to`.
double n_parts(const double from, const double to, const double size)
{
  return std::max(1., std::round((to - from) / size));
}

// Divides the interval from the last line to `to` into equal parts of about `size`, and appends their ends.
void append_parts(std::vector<double> &lines, const double to, const double size)
{
  const double from = lines.back();
  const unsigned int n = n_parts(from, to, size);
  for (unsigned int k = 1; k <= n; ++k)
    lines.push_back(k == n ? to : from + (to - from) * k / n);
}

// Returns half the side of the square of cells around a hole: twice the radius where the sheet is large enough.
double half_box(const RectangleWithHole &shape)
{
  return std::min(2. * shape.radius, 0.5 * (shape.radius + 0.5 * std::min(shape.length, shape.height)));
}

class CoarseMesh
{
public:
  unsigned int vertex(const double x, const double y)
  {
    vertices_.emplace_back(x, y);
    return vertices_.size() - 1;
  }

  // Adds a cell. Corners in lexicographic order: lower left, lower right, upper left, upper right.
  void cell(const unsigned int a, const unsigned int b, const unsigned int c, const unsigned int d)
  {
    CellData<2> data(4);
    data.vertices = {a, b, c, d};
    cells_.push_back(data);
  }

  // Creates the mesh. Outer edges get their ids by position, all other boundary edges the id `inner`.
  void create(parallel::distributed::Triangulation<2> &mesh, const double length, const double height) const
  {
    // A line must have the same orientation in both of its cells, or elements of degree 3 and higher do not match.
    std::vector<CellData<2>> cells = cells_;
    GridTools::consistently_order_cells(cells);
    mesh.create_triangulation(vertices_, cells, SubCellData());
    const double tolerance = 1e-9 * (length + height);
    for (const auto &cell : mesh.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
      {
        if (!face->at_boundary())
          continue;
        const Point<2> X = face->center();
        face->set_boundary_id(X[0] < tolerance                   ? edge::left
                              : X[0] > length - tolerance        ? edge::right
                              : X[1] < -0.5 * height + tolerance ? edge::bottom
                              : X[1] > 0.5 * height - tolerance  ? edge::top
                                                                 : edge::inner);
      }
  }

private:
  std::vector<Point<2>> vertices_;
  std::vector<CellData<2>> cells_;
};
} // namespace

void make_rectangle(parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle)
{
  const auto &[length, height, cells_x, cells_y, periodic_x, periodic_y] = rectangle;
  require_size(length, height);
  require(cells_x > 0 && cells_y > 0, "a rectangle needs at least one cell in each direction");
  // With a single cell across, the cell would be its own neighbour.
  require((!periodic_x || cells_x > 1) && (!periodic_y || cells_y > 1),
          "a periodic rectangle needs at least two cells across");

  // Prefer refined to coarse cells: refined cells are distributed and form the levels of multigrid.
  unsigned int halvings = 0, coarse_x = cells_x, coarse_y = cells_y;
  for (; coarse_x % 2 == 0 && coarse_y % 2 == 0; ++halvings)
  {
    coarse_x /= 2;
    coarse_y /= 2;
  }
  // With `colorize` the generator numbers the edges as continuum::edge does.
  GridGenerator::subdivided_hyper_rectangle(mesh, {coarse_x, coarse_y}, Point<2>(0., -0.5 * height),
                                            Point<2>(length, 0.5 * height), true);
  std::vector<GridTools::PeriodicFacePair<parallel::distributed::Triangulation<2>::cell_iterator>> pairs;
  if (periodic_x)
    GridTools::collect_periodic_faces(mesh, edge::left, edge::right, 0, pairs);
  if (periodic_y)
    GridTools::collect_periodic_faces(mesh, edge::bottom, edge::top, 1, pairs);
  if (!pairs.empty())
    mesh.add_periodicity(pairs);
  mesh.refine_global(halvings);
}

void make_rectangle_with_hole(parallel::distributed::Triangulation<2> &mesh, const RectangleWithHole &shape)
{
  const auto &[length, height, radius, refinements] = shape;
  require_size(length, height);
  const double smaller = std::min(length, height);
  require(radius > 0. && radius < 0.45 * smaller,
          "the radius of a hole must be positive and less than 0.45 times the length and the height");

  // A ring of cells around the hole within a square, and rows and columns of cells outside the square.
  const double half = half_box(shape);
  const double cx = 0.5 * length;
  std::vector<double> xs = {0.}, ys = {-0.5 * height};
  append_parts(xs, cx - half, 1.5 * half);
  const unsigned int box_x = xs.size() - 1;
  xs.insert(xs.end(), {cx, cx + half});
  append_parts(xs, length, 1.5 * half);
  append_parts(ys, -half, 1.5 * half);
  const unsigned int box_y = ys.size() - 1;
  ys.insert(ys.end(), {0., half});
  append_parts(ys, 0.5 * height, 1.5 * half);

  CoarseMesh coarse;
  const auto on_grid = [&xs](const unsigned int i, const unsigned int j)
  { return static_cast<unsigned int>(j * xs.size() + i); };
  for (const double y : ys)
    for (const double x : xs)
      coarse.vertex(x, y); // the vertex at the centre of the hole belongs to no cell
  for (unsigned int j = 0; j + 1 < ys.size(); ++j)
    for (unsigned int i = 0; i + 1 < xs.size(); ++i)
      if (i < box_x || i > box_x + 1 || j < box_y || j > box_y + 1)
        coarse.cell(on_grid(i, j), on_grid(i + 1, j), on_grid(i, j + 1), on_grid(i + 1, j + 1));
  unsigned int circle[8], box[8];
  const int around[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  for (unsigned int k = 0; k < 8; ++k)
  {
    const double angle = std::acos(-1.) * k / 4.;
    circle[k] = coarse.vertex(cx + radius * std::cos(angle), radius * std::sin(angle));
    box[k] = on_grid(box_x + 1 + around[k][0], box_y + 1 + around[k][1]);
  }
  for (unsigned int k = 0; k < 8; ++k)
    coarse.cell(circle[k], box[k], circle[(k + 1) % 8], box[(k + 1) % 8]);

  coarse.create(mesh, length, height);
  for (const auto &cell : mesh.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == edge::inner)
        face->set_manifold_id(rim);
  mesh.set_manifold(rim, SphericalManifold<2>(Point<2>(cx, 0.)));
  mesh.refine_global(refinements);
}

void make_notched_rectangle(parallel::distributed::Triangulation<2> &mesh, const NotchedRectangle &shape)
{
  const auto &[length, height, notch, refinements] = shape;
  require_size(length, height);
  require(notch > 0. && notch < length, "the notch must be longer than 0 and shorter than the sheet");

  std::vector<double> xs = {0.};
  append_parts(xs, notch, 0.5 * height);
  const unsigned int tip = xs.size() - 1;
  append_parts(xs, length, 0.5 * height);
  CoarseMesh coarse;
  std::vector<unsigned int> bottom, below, above, top;
  for (unsigned int i = 0; i < xs.size(); ++i)
  {
    bottom.push_back(coarse.vertex(xs[i], -0.5 * height));
    below.push_back(coarse.vertex(xs[i], 0.));
    above.push_back(i < tip ? coarse.vertex(xs[i], 0.) : below.back());
    top.push_back(coarse.vertex(xs[i], 0.5 * height));
  }
  for (unsigned int i = 0; i + 1 < xs.size(); ++i)
  {
    coarse.cell(bottom[i], bottom[i + 1], below[i], below[i + 1]);
    coarse.cell(above[i], above[i + 1], top[i], top[i + 1]);
  }
  coarse.create(mesh, length, height);
  mesh.refine_global(refinements);
}

double n_coarse_cells(const RectangleWithHole &shape)
{
  const double half = half_box(shape), pitch = 1.5 * half;
  const double columns = 2. * n_parts(0., 0.5 * shape.length - half, pitch) + 2.;
  const double rows = 2. * n_parts(0., 0.5 * shape.height - half, pitch) + 2.;
  return columns * rows - 4. + 8.; // eight cells around the hole replace the four in the square
}

double n_coarse_cells(const NotchedRectangle &shape)
{
  const double pitch = 0.5 * shape.height;
  return 2. * (n_parts(0., shape.notch, pitch) + n_parts(shape.notch, shape.length, pitch));
}
} // namespace latcon::continuum
