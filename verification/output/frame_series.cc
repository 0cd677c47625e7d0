#include "verification/output/frame_series.h"

#include <charconv>
#include <cstdio>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "support/atomic_file.h"
#include "verification/output/field_units.h"
#include "verification/output/vtk_file.h"

namespace latcon::output
{
namespace
{

std::string shortest(double value)
{
  char text[32];
  const auto result = std::to_chars(text, text + sizeof(text), value);
  return {text, result.ptr};
}

} // namespace

FrameSeries::FrameSeries(std::filesystem::path directory, std::string name)
  : directory_(std::move(directory)), name_(std::move(name))
{
}

std::string FrameSeries::file_name(std::size_t frame) const
{
  char number[32];
  std::snprintf(number, sizeof(number), "-%04zu.vtp", frame);
  return name_ + number;
}

void FrameSeries::add(vtkPolyData &frame, double time)
{
  vtkNew<vtkDoubleArray> time_value;
  time_value->SetName("TimeValue");
  set_unit(*time_value);
  time_value->InsertNextValue(time);
  frame.GetFieldData()->AddArray(time_value);

  if (!times_.empty() && times_.back() == time)
    times_.pop_back();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&frame);
  writer->SetCompressionLevel(1); // higher levels take a sixth of the time of a crack run and save a few percent
  write_vtk_file(*writer, directory_ / file_name(times_.size()));
  times_.push_back(time);
  write_collection();
}

void FrameSeries::write_collection() const
{
  std::string text =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
    "  <Collection>\n";
  for (std::size_t frame = 0; frame < times_.size(); ++frame)
    text +=
      "    <DataSet timestep=\"" + shortest(times_[frame]) + "\" part=\"0\" file=\"" + file_name(frame) + "\"/>\n";
  text += "  </Collection>\n</VTKFile>\n";
  support::write_atomically(directory_ / (name_ + ".pvd"), text, support::Sync::no);
}

} // namespace latcon::output
