#pragma once

#include "continuum/rectangle.h"

#include <filesystem>

namespace latcon::continuum
{
namespace edge
{
/// Rim of a hole, or both faces of a notch.
constexpr dealii::types::boundary_id inner = 4;
} // namespace edge

/// A rectangle with a round hole in its middle, at (length/2, 0).
struct RectangleWithHole
{
  double length;            ///< [m] > 0, from x = 0
  double height;            ///< [m] > 0, from y = -height/2
  double radius;            ///< [m] > 0, less than 0.45 of length and height
  unsigned int refinements; ///< each halves the cells; 0 leaves eight cells around the hole
};

/// A rectangle cut along y = 0 from its left edge, in the reference configuration a slit without width.
struct NotchedRectangle
{
  double length;            ///< [m] > 0, from x = 0
  double height;            ///< [m] > 0, from y = -height/2
  double notch;             ///< length of the slit [m], > 0 and < length
  unsigned int refinements; ///< each halves the cells; 0 leaves cells of about half the height
};

// Each meshes a domain into the empty `mesh`, with the boundary ids of continuum::edge. Collective. They throw
// InvalidInput for sizes out of range.

/// The rim is a circle for every element degree: Sheet takes its mapping from it.
void make_rectangle_with_hole(dealii::parallel::distributed::Triangulation<2> &mesh, const RectangleWithHole &shape);

/// The faces of the notch are free to part.
void make_notched_rectangle(dealii::parallel::distributed::Triangulation<2> &mesh, const NotchedRectangle &shape);

/// Cells of such a mesh before it is refined, to be known before it is made: there may be more than memory for.
double n_coarse_cells(const RectangleWithHole &shape);
/// Likewise.
double n_coarse_cells(const NotchedRectangle &shape);
/// Likewise. Throws as read_gmsh does.
double n_coarse_cells(const std::filesystem::path &gmsh_file);

/// Reads quadrilaterals in a plane z = const, coordinates in metres, from a Gmsh file (.msh, format 2 or 4.1, ASCII).
/// Boundary ids are the numbers of the physical curves, one of continuum::edge for every edge; for a curve without a
/// number Gmsh itself writes 0, edge::left, in format 2. Straight edges only. Throws InvalidInput, naming the file, if
/// it cannot be read or is no such mesh.
void read_gmsh(dealii::parallel::distributed::Triangulation<2> &mesh, const std::filesystem::path &file,
               unsigned int refinements = 0);
} // namespace latcon::continuum
