#include "support/pvd.h"

#include "support/full_precision.h"

namespace latcon::support
{

std::string pvd_text(const std::vector<PvdFile> &files)
{
  std::string text =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
    "  <Collection>\n";
  for (const PvdFile &file : files)
    text += "    <DataSet timestep=\"" + full_precision(file.time) + "\" part=\"0\" file=\"" + file.name + "\"/>\n";
  return text + "  </Collection>\n</VTKFile>\n";
}

} // namespace latcon::support
