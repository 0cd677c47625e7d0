#pragma once

#include <filesystem>

class vtkXMLWriter;

namespace latcon::output
{

/// Writes the input of a VTK writer as compressed, appended binary data; replaces the file atomically.
/// @throws support::OutputError
void write_vtk_file(vtkXMLWriter &writer, const std::filesystem::path &path);

} // namespace latcon::output
