#pragma once

#include <deal.II/grid/tria_description.h>

#include <deal.II/base/point.h>

#include <filesystem>
#include <vector>

namespace latcon::continuum
{
/// Mesh of a Gmsh file: nodes [m], quadrilaterals, and lines with the boundary ids of continuum::edge.
struct GmshMesh
{
  std::vector<dealii::Point<2>> points;
  std::vector<dealii::CellData<2>> cells;
  dealii::SubCellData lines;
};

/// Reads the mesh of a file of at most 256 MiB as read_gmsh() describes it, on this process. Throws InvalidInput, with
/// the name of the file and the line, node, element or edge at fault.
GmshMesh read_gmsh_file(const std::filesystem::path &file);
} // namespace latcon::continuum
