/// Frames of both sides, as read from their files.
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

/// Meaning of the time of a frame.
enum class TimeKind
{
  motion,      ///< seconds
  equilibrium, ///< load factor
  start        ///< time 0: start of a motion, or unloaded state
};

/// Common part of the frames of both sides. Points are at reference positions [m].
struct Frame
{
  FrameFile file;
  double time = 0.; ///< [s], or load factor [-]
  TimeKind kind = TimeKind::start;
  std::vector<Position> points;
  std::vector<FieldValues> fields; ///< finite, at the points; in the order of common_fields

  /// Returns the field with this name; null if the frame does not have it.
  const FieldValues *find(const std::string &name) const;
};

/// Frame of a lattice: sites and bonds.
struct LatticeFrame : Frame
{
  vtkSmartPointer<vtkPolyData> data; ///< content of the file
  std::vector<std::array<std::size_t, 2>> bonds;
  std::vector<std::uint8_t> held;    ///< 1 at sites whose motion is prescribed
  std::vector<unsigned int> n_bonds; ///< per site
  double spacing = 0.;               ///< length of the shortest undeformed bond [m]
  /// Bounds of the undeformed sheet, if the file contains them: X from, to, Y from, to [m].
  std::optional<std::array<double, 4>> sheet_bounds;
};

/// Quadrilateral of degree p: geometry and fields are Lagrange polynomials on (p + 1)^2 equidistant nodes.
struct Cell
{
  unsigned int degree;
  std::size_t first_node; ///< in ContinuumFrame::nodes; the first coordinate runs fastest
};

/// Frame of finite elements. Each point belongs to one cell, so fields may jump between cells.
struct ContinuumFrame : Frame
{
  vtkSmartPointer<vtkUnstructuredGrid> data; ///< content of the file, with the pieces of a .pvtu merged
  std::vector<Cell> cells;
  std::vector<std::size_t> nodes; ///< points of the cells
};

/// Reads a lattice frame and checks it. It is of a motion if it has velocities; at rest at time 0 it may be the start
/// of a motion or of an equilibrium.
/// @param time required time [s], or load factor [-] @throws InputError if VTK cannot read the file, if an array is
/// missing, has the wrong size or contains a value that is not finite, if there are no bonds, or if the frame has
/// another time
LatticeFrame read_lattice_frame(const FrameFile &file, std::optional<double> time = {});

/// Reads a continuum frame and checks it. It is of a motion if it has the field `velocity`.
/// @throws InputError as read_lattice_frame(), and for cells other than linear or Lagrange quadrilaterals
ContinuumFrame read_continuum_frame(const FrameFile &file, std::optional<double> time = {});

} // namespace latcon::compare
