#include "verification/output/frame_series.h"

#include <cstdio>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "support/atomic_file.h"
#include "support/pvd.h"
#include "verification/output/point_data.h"
#include "verification/output/vtk_file.h"

namespace latcon::output
{

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
  write_vtk_file(*writer, directory_ / file_name(times_.size()));
  times_.push_back(time);
  write_collection();
}

void FrameSeries::write_collection() const
{
  std::vector<support::PvdFile> files;
  for (std::size_t frame = 0; frame < times_.size(); ++frame)
    files.push_back({times_[frame], file_name(frame)});
  support::write_atomically(directory_ / (name_ + ".pvd"), support::pvd_text(files), support::Sync::no);
}

} // namespace latcon::output
