#include "continuum/meshes.h"

#include "continuum/collective.h"
#include "continuum/errors.h"
#include "continuum/gmsh_file.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
constexpr types::manifold_id rim = 1;

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

void make_rectangle_with_hole(parallel::distributed::Triangulation<2> &mesh, const RectangleWithHole &shape)
{
  const auto &[length, height, radius, refinements] = shape;
  require(length > 0. && height > 0. && std::isfinite(length) && std::isfinite(height),
          "the length and height of a rectangle must be positive and finite");
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
  require(length > 0. && height > 0. && std::isfinite(length) && std::isfinite(height),
          "the length and height of a rectangle must be positive and finite");
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

double n_coarse_cells(const std::filesystem::path &gmsh_file)
{
  return read_gmsh_file(gmsh_file).cells.size();
}

void read_gmsh(parallel::distributed::Triangulation<2> &mesh, const std::filesystem::path &file,
               const unsigned int refinements)
{
  GmshMesh read;
  // An exception on one rank must not leave the others waiting.
  run_collectively(mesh.get_communicator(), [&] { read = read_gmsh_file(file); });
  GridTools::consistently_order_cells(read.cells);
  mesh.create_triangulation(read.points, read.cells, read.lines);
  mesh.refine_global(refinements);
}
} // namespace latcon::continuum
