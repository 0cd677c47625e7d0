#include "verification/compare/frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkFieldData.h>
#include <vtkHigherOrderQuadrilateral.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "support/errors.h"
#include "support/full_precision.h"
#include "verification/compare/quiet_vtk.h"

namespace latcon::compare
{
namespace
{

[[noreturn]] void fail(const FrameFile &file, const std::string &problem)
{
  throw support::InputError(file.path.string() + ": " + problem);
}

// Reads a file with a reader of VTK.
template <typename Reader>
auto read_data(const FrameFile &file)
{
  QuietVtk quiet;
  vtkNew<Reader> reader;
  reader->SetFileName(file.path.c_str());
  if (reader->CanReadFile(file.path.c_str()) != 1)
    fail(file, "not a VTK file of the type that its name says");
  try
  {
    reader->Update();
  }
  catch (const std::length_error &)
  {
    fail(file, "corrupt: invalid size of an array");
  }
  vtkSmartPointer data = reader->GetOutput();
  if (!quiet.error().empty())
    fail(file, "corrupt: " + quiet.error());
  if (reader->GetErrorCode() != 0 || data->GetNumberOfPoints() == 0)
    fail(file, "truncated, or without points");
  return data;
}

vtkDataArray &array(const FrameFile &file, vtkDataSet &data, const char *name, int components)
{
  vtkDataArray *const values = data.GetPointData()->GetArray(name);
  if (values == nullptr)
    fail(file, std::string("has no point data '") + name + "'");
  if (values->GetNumberOfComponents() != components || values->GetNumberOfTuples() != data.GetNumberOfPoints())
    fail(file, std::string("'") + name + "' has " + std::to_string(values->GetNumberOfComponents()) +
                 " components where " + std::to_string(components) + " are expected, or not a value for every point");
  return *values;
}

FieldValues read_field(const FrameFile &file, vtkDataSet &data, const CommonField &field)
{
  // Vectors in files have three and tensors nine components; the in-plane components are 0, 1 and 0, 1, 3, 4.
  constexpr std::array<int, 4> in_plane{{0, 1, 3, 4}};
  const int in_file = field.components == 1 ? 1 : field.components == 2 ? 3 : 9;
  vtkDataArray &values = array(file, data, field.name, in_file);
  const auto n = static_cast<std::size_t>(data.GetNumberOfPoints());
  FieldValues read{&field, std::vector<double>(n * field.components)};
  std::size_t bad = 0;
  for (std::size_t point = 0; point < n; ++point)
  {
    bool finite = true;
    for (std::size_t c = 0; c < field.components; ++c)
    {
      const double value = values.GetComponent(static_cast<vtkIdType>(point), in_plane[c]);
      read.values[point * field.components + c] = value;
      finite = finite && std::isfinite(value);
    }
    bad += finite ? 0 : 1;
  }
  if (bad > 0)
    fail(file, std::string("'") + field.name + "' is not finite at " + std::to_string(bad) + " of " +
                 std::to_string(n) + " points");
  return read;
}

std::vector<Position> read_points(const FrameFile &file, vtkPointSet &data)
{
  std::vector<Position> points(static_cast<std::size_t>(data.GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    std::array<double, 3> x{};
    data.GetPoint(static_cast<vtkIdType>(i), x.data());
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]))
      fail(file, "the position of a point is not finite");
    points[i] = {{x[0], x[1]}};
  }
  return points;
}

// Returns the time given by the series, otherwise that in the file.
double frame_time(const FrameFile &file, vtkDataSet &data, std::optional<double> wanted)
{
  if (file.time)
    return *file.time;
  vtkDataArray *const time = data.GetFieldData()->GetArray("TimeValue");
  if (time == nullptr || time->GetNumberOfTuples() != 1 || !std::isfinite(time->GetComponent(0, 0)))
    fail(file, "has no field data 'TimeValue', so its time is unknown");
  const double found = time->GetComponent(0, 0);
  if (wanted && !is_same_time(found, *wanted))
    fail(file, "has the time " + support::full_precision(found) + ", not " + support::full_precision(*wanted));
  return found;
}

double length(const Position &a, const Position &b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

// Adds a cell of VTK with its nodes ordered by rows and columns.
void add_cell(ContinuumFrame &frame, vtkIdType id)
{
  vtkIdType n = 0;
  const vtkIdType *points = nullptr;
  frame.data->GetCells()->GetCellAtId(id, n, points);
  const int type = frame.data->GetCellType(id);
  const auto side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(n))));
  if ((type != VTK_QUAD && type != VTK_LAGRANGE_QUADRILATERAL) || side < 2 || side > 32 ||
      static_cast<vtkIdType>(side) * side != n)
    fail(frame.file, "has a cell that is not a quadrilateral of equal degree in both directions (VTK type " +
                       std::to_string(type) + " with " + std::to_string(n) + " points)");
  const std::array<int, 2> order{{side - 1, side - 1}};
  frame.cells.push_back({static_cast<unsigned int>(side - 1), frame.nodes.size()});
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      frame.nodes.push_back(
        static_cast<std::size_t>(points[vtkHigherOrderQuadrilateral::PointIndexFromIJK(i, j, order.data())]));
}

} // namespace

const FieldValues *Frame::find(const std::string &name) const
{
  for (const FieldValues &field : fields)
    if (field.field->name == name)
      return &field;
  return nullptr;
}

LatticeFrame read_lattice_frame(const FrameFile &file, std::optional<double> time)
{
  LatticeFrame frame;
  frame.file = file;
  frame.data = read_data<vtkXMLPolyDataReader>(file);
  frame.time = frame_time(file, *frame.data, time);
  frame.points = read_points(file, *frame.data);
  if (vtkDataArray *const bounds = frame.data->GetFieldData()->GetArray("SheetBounds"))
  {
    if (bounds->GetNumberOfComponents() != 4 || bounds->GetNumberOfTuples() != 1)
      fail(file, "its field data 'SheetBounds' must be four numbers");
    frame.sheet_bounds.emplace();
    bounds->GetTuple(0, frame.sheet_bounds->data());
  }
  for (const CommonField &field : common_fields)
    frame.fields.push_back(read_field(file, *frame.data, field));
  const std::vector<double> &velocity = frame.find("velocity")->values;
  const bool at_rest = std::all_of(velocity.begin(), velocity.end(), [](double v) { return v == 0.; });
  if (!at_rest)
    frame.kind = TimeKind::motion;
  else
    frame.kind = frame.time == 0. ? TimeKind::start : TimeKind::equilibrium;

  vtkDataArray &held = array(file, *frame.data, "held", 1);
  frame.held.resize(frame.points.size());
  for (std::size_t i = 0; i < frame.held.size(); ++i)
    frame.held[i] = held.GetComponent(static_cast<vtkIdType>(i), 0) != 0. ? 1 : 0;

  frame.n_bonds.assign(frame.points.size(), 0);
  vtkCellArray *const lines = frame.data->GetLines();
  for (vtkIdType id = 0; id < lines->GetNumberOfCells(); ++id)
  {
    vtkIdType n = 0;
    const vtkIdType *ends = nullptr;
    lines->GetCellAtId(id, n, ends);
    if (n != 2)
      fail(file, "a line has " + std::to_string(n) + " points, so it is not a bond");
    const std::array<std::size_t, 2> bond{{static_cast<std::size_t>(ends[0]), static_cast<std::size_t>(ends[1])}};
    for (const std::size_t end : bond)
      ++frame.n_bonds[end];
    const double bond_length = length(frame.points[bond[0]], frame.points[bond[1]]);
    frame.spacing = frame.bonds.empty() ? bond_length : std::min(frame.spacing, bond_length);
    frame.bonds.push_back(bond);
  }
  if (!(frame.spacing > 0.))
    fail(file, "has no bonds, or a bond of zero length, so it is not a lattice");
  return frame;
}

ContinuumFrame read_continuum_frame(const FrameFile &file, std::optional<double> time)
{
  ContinuumFrame frame;
  frame.file = file;
  frame.data = file.path.extension() == ".pvtu" ? read_data<vtkXMLPUnstructuredGridReader>(file)
                                                : read_data<vtkXMLUnstructuredGridReader>(file);
  frame.time = frame_time(file, *frame.data, time);
  frame.points = read_points(file, *frame.data);
  const bool moves = frame.data->GetPointData()->GetArray("velocity") != nullptr;
  frame.kind = moves ? TimeKind::motion : frame.time == 0. ? TimeKind::start : TimeKind::equilibrium;
  for (const CommonField &field : common_fields)
    if (!field.in_motion_only || moves)
      frame.fields.push_back(read_field(file, *frame.data, field));
  for (vtkIdType id = 0; id < frame.data->GetNumberOfCells(); ++id)
    add_cell(frame, id);
  if (frame.cells.empty())
    fail(file, "has no cells");
  return frame;
}

} // namespace latcon::compare
