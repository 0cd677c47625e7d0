#pragma once

#include <filesystem>

class vtkXMLWriter;

namespace latcon::output
{

/// Writes the input of a VTK writer as appended binary data, compressed by LZ4; replaces the file atomically.
/// @throws support::OutputError
void write_vtk_file(vtkXMLWriter &writer, const std::filesystem::path &path);

} // namespace latcon::output
