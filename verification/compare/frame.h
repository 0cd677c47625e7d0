/// Frames of either side, read from their files and checked.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include "verification/compare/fields.h"
#include "verification/compare/frame_file.h"

namespace latcon::compare
{

/// What a frame's time means.
enum class TimeKind
{
  motion,      ///< seconds
  equilibrium, ///< load factor
  start        ///< 0 of either
};

/// What both sides have. Points are at reference positions [m].
struct Frame
{
  FrameFile file;
  double time = 0.; ///< [s], or load factor [-]
  TimeKind kind = TimeKind::start;
  std::vector<Position> points;
  std::vector<FieldValues> fields; ///< finite, at the points; in the order of common_fields

  /// Null if the frame does not have it.
  const FieldValues *find(const std::string &name) const;
};

/// The sites of a lattice and the bonds between them.
struct LatticeFrame : Frame
{
  vtkSmartPointer<vtkPolyData> data; ///< the file's content
  std::vector<std::array<std::size_t, 2>> bonds;
  std::vector<std::uint8_t> held;    ///< 1 where the motion is prescribed
  std::vector<unsigned int> n_bonds; ///< of each site
  double spacing = 0.;               ///< length of the shortest undeformed bond [m]
  /// Bounds of the undeformed sheet if the file says them: X from, to, Y from, to [m].
  std::optional<std::array<double, 4>> sheet_bounds;
};

/// A quadrilateral of degree p, whose geometry and fields are Lagrange polynomials between (p + 1)^2 equidistant nodes.
struct Cell
{
  unsigned int degree;
  std::size_t first_node; ///< in ContinuumFrame::nodes; the first coordinate runs fastest
};

/// The sheet in finite elements. Points belong to one cell each, so that fields may jump between cells.
struct ContinuumFrame : Frame
{
  vtkSmartPointer<vtkUnstructuredGrid> data; ///< the file's content, the pieces of a .pvtu in one
  std::vector<Cell> cells;
  std::vector<std::size_t> nodes; ///< points of the cells
};

/// Reads a frame. In motion a lattice has velocities; at rest at time 0 it may be the start of either.
/// @throws InputError if VTK cannot read the file, or it lacks an array, or one has the wrong size or holds a value
/// that is not finite, or it has no bonds, or if a time was asked for and the frame has another
LatticeFrame read_lattice_frame(const FrameFile &file, std::optional<double> time = {});

/// The same. In motion the continuum has the field `velocity`.
/// @throws InputError as above, and for cells other than quadrilaterals, linear or Lagrange's
ContinuumFrame read_continuum_frame(const FrameFile &file, std::optional<double> time = {});

} // namespace latcon::compare
