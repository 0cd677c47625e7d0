#pragma once

#include <deal.II/distributed/tria.h>

#include <filesystem>

namespace latcon::continuum
{
/// Boundary ids of meshes.
namespace edge
{
constexpr dealii::types::boundary_id left = 0;   ///< smallest X
constexpr dealii::types::boundary_id right = 1;  ///< largest X
constexpr dealii::types::boundary_id bottom = 2; ///< smallest Y
constexpr dealii::types::boundary_id top = 3;    ///< largest Y
constexpr dealii::types::boundary_id inner = 4;  ///< rim of a hole, or both faces of a notch
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

/// Rectangle with a circular hole centred at (length/2, 0).
struct RectangleWithHole
{
  double length;            ///< [m] > 0, from x = 0
  double height;            ///< [m] > 0, from y = -height/2
  double radius;            ///< [m] > 0, less than 0.45 of length and height
  unsigned int refinements; ///< number of times all cells are halved; 0: eight cells around the hole
};

/// Rectangle with a notch along y = 0 from its left edge: a slit of zero width in the reference configuration.
struct NotchedRectangle
{
  double length;            ///< [m] > 0, from x = 0
  double height;            ///< [m] > 0, from y = -height/2
  double notch;             ///< length of the slit [m], > 0 and < length
  unsigned int refinements; ///< number of times all cells are halved; 0: cells of about half the height
};

// Mesh generators. Each fills the empty `mesh`, with the boundary ids of continuum::edge. Collective. Throw
// InvalidInput for sizes out of range.

/// Generates the mesh of a rectangle. Common factors of two of cells_x and cells_y become refinements of a coarse mesh,
/// which is replicated on every rank. A periodic mesh still has its four edges; PeriodicPair constrains the
/// displacement. Throws InvalidInput for too few cells as well.
void make_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const Rectangle &rectangle);

/// Generates the mesh of a rectangle with a hole. A manifold describes the rim as a circle, so that Sheet maps cells at
/// the rim to the degree of its elements.
void make_rectangle_with_hole(dealii::parallel::distributed::Triangulation<2> &mesh, const RectangleWithHole &shape);

/// Generates the mesh of a notched rectangle, with separate nodes on the two faces of the notch.
void make_notched_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const NotchedRectangle &shape);

/// Returns the number of cells before refinement, without generating the mesh, to check the memory it needs.
double n_coarse_cells(const RectangleWithHole &shape);
/// Returns the number of cells before refinement; see above.
double n_coarse_cells(const NotchedRectangle &shape);
/// Returns the number of cells of a file before refinement. Throws as read_gmsh() does.
double n_coarse_cells(const std::filesystem::path &gmsh_file);

/// Reads quadrilaterals in a plane z = const, coordinates in metres, from a Gmsh file (.msh, version 2 or 4.1, ASCII,
/// first order, at most 256 MiB). Every boundary edge must lie on one physical curve. If any physical curve has a name,
/// boundary ids follow from the names left, right, bottom, top and inner, whatever the numbers; otherwise they are the
/// numbers, from continuum::edge. A line off the boundary must not have such a name. In version 2 Gmsh writes 0 for
/// elements without a group, so the physical surface must have another number. Then halves all cells `refinements`
/// times. Not supported: curved edges, cells that are not convex. Throws InvalidInput, with the name of the file, if it
/// cannot be read or contains another kind of mesh.
void read_gmsh(dealii::parallel::distributed::Triangulation<2> &mesh, const std::filesystem::path &file,
               unsigned int refinements = 0);
} // namespace latcon::continuum
