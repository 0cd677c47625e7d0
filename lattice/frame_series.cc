#include "lattice/frame_series.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <system_error>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "lattice/field_units.h"

namespace lattice
{
namespace
{

[[noreturn]] void fail(const std::filesystem::path &path, const char *what)
{
  throw std::filesystem::filesystem_error(what, path, std::make_error_code(std::errc::io_error));
}

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
  const std::string name = file_name(times_.size());
  const std::filesystem::path path = directory_ / name;
  const std::filesystem::path beside = directory_ / (name + ".part");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(beside.c_str());
  writer->SetInputData(&frame);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(1); // higher ones take a sixth of a crack's time to save a few percent
  if (writer->Write() != 1 || writer->GetErrorCode() != 0)
    fail(path, "cannot write lattice frame");
  std::filesystem::rename(beside, path);
  times_.push_back(time);
  write_collection();
}

void FrameSeries::write_collection() const
{
  const std::filesystem::path path = directory_ / (name_ + ".pvd");
  const std::filesystem::path beside = path.string() + ".part";
  {
    std::ofstream out(beside);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
           "  <Collection>\n";
    for (std::size_t frame = 0; frame < times_.size(); ++frame)
      out << "    <DataSet timestep=\"" << shortest(times_[frame]) << "\" part=\"0\" file=\"" << file_name(frame)
          << "\"/>\n";
    out << "  </Collection>\n</VTKFile>\n";
    out.flush();
    if (!out)
      fail(path, "cannot write");
  }
  std::filesystem::rename(beside, path);
}

} // namespace lattice
