#pragma once

#include <filesystem>

class vtkXMLWriter;

namespace lattice
{

/// Writes the input of a VTK writer as compressed, appended binary data, whole at any moment.
/// @throws latcon::support::OutputError
void write_vtk_file(vtkXMLWriter &writer, const std::filesystem::path &path);

} // namespace lattice
