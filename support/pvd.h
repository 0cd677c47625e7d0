/// Series of frames for ParaView.
#pragma once

#include <string>
#include <vector>

namespace latcon::support
{

/// A file of a series, relative to the folder of the .pvd.
struct PvdFile
{
  double time; ///< [s], or another parameter of the series; one file for each
  std::string name;
};

/// Returns the text of a .pvd file. Times are in full precision.
[[nodiscard]] std::string pvd_text(const std::vector<PvdFile> &files);

} // namespace latcon::support
