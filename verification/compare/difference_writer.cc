#include "verification/compare/difference_writer.h"

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "support/errors.h"
#include "support/pvd.h"
#include "verification/compare/quiet_vtk.h"
#include "verification/output/output_file.h"

namespace latcon::compare
{
namespace
{

constexpr const char *sites_file = "difference_sites.vtp";
constexpr const char *continuum_file = "difference_continuum.vtu";

// Adds a field with three components for vectors and nine for tensors, as ParaView expects.
void add_field(vtkPointData &data, const FieldValues &field, const char *suffix)
{
  constexpr std::array<int, 4> in_plane{{0, 1, 3, 4}};
  const std::size_t n_components = field.field->components;
  const std::size_t n = field.values.size() / n_components;
  vtkNew<vtkDoubleArray> values;
  values->SetName((std::string(field.field->name) + suffix).c_str());
  values->SetNumberOfComponents(n_components == 1 ? 1 : n_components == 2 ? 3 : 9);
  values->SetNumberOfTuples(static_cast<vtkIdType>(n));
  values->Fill(0.);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < n_components; ++c)
      values->SetComponent(static_cast<vtkIdType>(i), in_plane[c], field.at(i)[c]);
  data.AddArray(values);
}

void add_mark(vtkPointData &data, const std::vector<std::uint8_t> &mark, const char *name)
{
  vtkNew<vtkUnsignedCharArray> values;
  values->SetName(name);
  values->SetNumberOfTuples(static_cast<vtkIdType>(mark.size()));
  for (std::size_t i = 0; i < mark.size(); ++i)
    values->SetValue(static_cast<vtkIdType>(i), mark[i]);
  data.AddArray(values);
}

template <typename Writer, typename Data>
void write_data(const std::string &path, Data *data)
{
  QuietVtk quiet;
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || !quiet.error().empty())
    throw support::OutputError(path, quiet.error().empty() ? "VTK could not write it" : quiet.error());
  output::write_file(path, writer->GetOutputString());
}

} // namespace

void write_difference(const std::string &directory, const LatticeFrame &lattice, const ContinuumFrame &continuum,
                      const Comparison &comparison)
{
  vtkNew<vtkPolyData> sites;
  sites->ShallowCopy(lattice.data);
  vtkPointData &data = *sites->GetPointData();
  for (const FieldValues &field : comparison.continuum.fields)
    add_field(data, field, "_continuum");
  for (const FieldValues &field : comparison.differences)
    add_field(data, field, "_difference");
  add_mark(data, comparison.continuum.outside, "outside");
  add_mark(data, comparison.complete, "complete");
  add_mark(data, comparison.excluded, "excluded");
  write_data<vtkXMLPolyDataWriter>(directory + "/" + sites_file, sites.Get());
  write_data<vtkXMLUnstructuredGridWriter>(directory + "/" + continuum_file, continuum.data.Get());

  output::write_file(directory + "/difference.pvd",
                     support::pvd_text({{lattice.time, sites_file, 0}, {lattice.time, continuum_file, 1}}));
}

} // namespace latcon::compare
