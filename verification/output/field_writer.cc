#include "verification/output/field_writer.h"

#include <limits>
#include <system_error>
#include <type_traits>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>

#include "lattice/site_fields.h"
#include "support/atomic_file.h"
#include "support/pvd.h"
#include "support/text_wrap.h"
#include "verification/analysis/fragments.h"

namespace latcon::output
{
namespace
{

// Sets the unit of a field as VTK's `UNITS_LABEL`. @param unit null for a field that is no quantity
void set_unit(vtkDataArray &field, const char *unit)
{
  if (unit != nullptr)
    field.GetInformation()->Set(vtkDataArray::UNITS_LABEL(), unit);
}

// Appends a field with its unit to the data of n points, cells, or a whole frame. ParaView expects three components of
// vectors and nine of tensors.
// @param value called with a point's index; returns a number, Eigen::Vector2d or Eigen::Matrix2d
template <class Array, class Value>
void add_field(vtkFieldData &data, const char *name, const char *unit, std::size_t n, const Value &value)
{
  using T = std::decay_t<decltype(value(n))>;
  constexpr bool is_vector = std::is_same_v<T, Eigen::Vector2d>, is_tensor = std::is_same_v<T, Eigen::Matrix2d>;
  vtkNew<Array> field;
  field->SetName(name);
  field->SetNumberOfComponents(is_tensor ? 9 : is_vector ? 3 : 1);
  field->SetNumberOfTuples(static_cast<vtkIdType>(n));
  set_unit(*field, unit);
  auto to = field->GetPointer(0);
  const auto append = [&to](auto... components)
  { ((*to++ = static_cast<typename Array::ValueType>(components)), ...); };
  for (std::size_t i = 0; i < n; ++i)
  {
    const T v = value(i);
    if constexpr (is_tensor)
      append(v(0, 0), v(0, 1), 0., v(1, 0), v(1, 1), 0., 0., 0., 0.);
    else if constexpr (is_vector)
      append(v.x(), v.y(), 0.);
    else
      append(v);
  }
  data.AddArray(field);
}

// Error codes of VTK start after those of the system.
std::string reason(unsigned long code)
{
  if (code == vtkErrorCode::OutOfDiskSpaceError)
    return std::make_error_code(std::errc::no_space_on_device).message();
  return code > 0 && code < vtkErrorCode::FirstVTKErrorCode ? std::generic_category().message(static_cast<int>(code))
                                                            : "VTK error " + std::to_string(code);
}

// Writes the input of a VTK writer as appended binary data, compressed by LZ4; replaces the file atomically.
// @throws support::OutputError
void write_vtk_file(vtkXMLWriter &writer, const std::filesystem::path &path)
{
  support::AtomicFile file(path);
  vtkObject::GlobalWarningDisplayOff(); // VTK would print lines of its own before the message
  writer.SetFileName(file.name().c_str());
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  // A tenth of the time of zlib, which took a sixth of a crack run, for files that are half as large again.
  writer.SetCompressorTypeToLZ4();
  if (writer.Write() != 1 || writer.GetErrorCode() != 0)
    throw support::OutputError(path, reason(writer.GetErrorCode()));
  file.commit(support::Sync::no);
}

using Slots = std::vector<std::size_t>; // of the points, in their order

void add_fields(vtkPolyData &frame, const lattice::State &state, const lattice::TriangularLattice &sheet,
                const lattice::Material &material, const Slots &slots)
{
  const std::vector<lattice::SiteValues> values = site_fields(state, sheet, material);
  const analysis::Fragments fragments = analysis::find_fragments(state, sheet);
  lattice::StrainGradientFit gradient_fit(sheet);
  std::vector<lattice::StrainGradient> gradients;
  const Eigen::Matrix2d unknown = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  gradients.reserve(slots.size());
  for (const std::size_t slot : sheet.is_triangular() ? slots : Slots())
    gradients.push_back(gradient_fit.at(state, slot).value_or(lattice::StrainGradient{unknown, unknown}));
  vtkPointData &data = *frame.GetPointData();
  const std::size_t n = slots.size();
  const auto add = [&](const char *name, const char *unit, const auto &of_site)
  { add_field<vtkDoubleArray>(data, name, unit, n, [&](std::size_t i) { return values[slots[i]].*of_site; }); };
  add("deformation_gradient", "1", &lattice::SiteValues::deformation_gradient);
  add("first_piola_stress", "Pa", &lattice::SiteValues::first_piola_stress);
  add("cauchy_stress", "Pa", &lattice::SiteValues::cauchy_stress);
  if (!gradients.empty())
  {
    add_field<vtkDoubleArray>(data, "strain_gradient_x", "1/m", n, [&](std::size_t i) { return gradients[i].x; });
    add_field<vtkDoubleArray>(data, "strain_gradient_y", "1/m", n, [&](std::size_t i) { return gradients[i].y; });
  }
  add("strain_energy_density", "J/m^3", &lattice::SiteValues::strain_energy_density);
  add("damage", "1", &lattice::SiteValues::damage);
  add_field<vtkUnsignedCharArray>(data, "held", nullptr, n, [&](std::size_t i) { return state.held[slots[i]]; });
  add_field<vtkIdTypeArray>(data, "site", nullptr, n, [&](std::size_t i) { return sheet.site_number(slots[i]); });
  add_field<vtkIdTypeArray>(data, "fragment", nullptr, n, [&](std::size_t i) { return fragments.number[slots[i]]; });
  // The outermost sites of a periodic sheet are inside its ends.
  vtkNew<vtkDoubleArray> bounds;
  bounds->SetName("SheetBounds");
  bounds->SetNumberOfComponents(4);
  bounds->InsertNextTuple4(0., sheet.length(), -0.5 * sheet.height(), 0.5 * sheet.height());
  set_unit(*bounds, "m");
  frame.GetFieldData()->AddArray(bounds);
}

// Adds the bonds as lines. Cell data has the vertices first, then the lines; a site has the mean of its bonds, so that
// it has the colour of its surroundings.
void add_bonds(vtkPolyData &frame, const lattice::State &state, const lattice::TriangularLattice &sheet,
               const Slots &slots)
{
  std::vector<vtkIdType> point_of_slot(sheet.n_places(), -1);
  for (std::size_t i = 0; i < slots.size(); ++i)
    point_of_slot[slots[i]] = static_cast<vtkIdType>(i);
  vtkNew<vtkCellArray> lines;
  std::vector<double> stretches(slots.size(), 0.);
  std::vector<unsigned char> shells(slots.size(), 0), toughened(slots.size(), 0);
  std::vector<unsigned int> bonds_of_point(slots.size(), 0);
  for_each_bond(state, sheet,
                [&](const lattice::Bond &bond)
                {
                  if (point_of_slot[bond.far] < 0)
                    return; // across a periodic edge: it would be drawn as a line through the whole sheet
                  const std::array<vtkIdType, 2> ends{{point_of_slot[bond.near], point_of_slot[bond.far]}};
                  lines->InsertNextCell(2, ends.data());
                  const double value = stretch(state, sheet, bond);
                  stretches.push_back(value);
                  for (const vtkIdType end : ends)
                  {
                    stretches[static_cast<std::size_t>(end)] += value;
                    ++bonds_of_point[static_cast<std::size_t>(end)];
                  }
                  shells.push_back(static_cast<unsigned char>(sheet.shell(bond.kind) + 1));
                  toughened.push_back(state.bonds.toughened(bond.near, bond.kind) ? 1 : 0);
                });
  for (std::size_t i = 0; i < slots.size(); ++i)
    stretches[i] = bonds_of_point[i] > 0 ? stretches[i] / bonds_of_point[i] : 1.;
  frame.SetLines(lines);
  vtkCellData &data = *frame.GetCellData();
  const std::size_t n = stretches.size();
  add_field<vtkDoubleArray>(data, "stretch", "1", n, [&](std::size_t i) { return stretches[i]; });
  add_field<vtkUnsignedCharArray>(data, "shell", nullptr, n, [&](std::size_t i) { return shells[i]; });
  add_field<vtkUnsignedCharArray>(data, "toughened", nullptr, n, [&](std::size_t i) { return toughened[i]; });
  data.SetActiveScalars("stretch");
}

} // namespace

FieldWriter::FieldWriter(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         std::filesystem::path directory, std::string name, FrameFields fields)
  : lattice_(lattice), material_(material), directory_(std::move(directory)), name_(std::move(name)), fields_(fields)
{
}

void FieldWriter::add_frame(const lattice::State &state)
{
  Slots slots;
  vtkNew<vtkPoints> points; // in single precision
  if (fields_ == FrameFields::all)
    points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (std::size_t row = 0; row < lattice_.rows(); ++row)
    for (std::size_t column = 0; column < lattice_.sites_in_row(row); ++column)
    {
      const std::size_t slot = lattice_.index(row, column);
      if (state.removed[slot] != 0)
        continue;
      const Eigen::Vector2d reference = lattice_.reference(slot);
      const vtkIdType id = points->InsertNextPoint(reference.x(), reference.y(), 0.);
      vertices->InsertNextCell(1, &id);
      slots.push_back(slot);
    }
  vtkNew<vtkPolyData> frame;
  frame->SetPoints(points);
  frame->SetVerts(vertices);
  vtkPointData &data = *frame->GetPointData();
  const auto displacement = [&](std::size_t i) -> Eigen::Vector2d
  { return state.position.at(slots[i]) - lattice_.reference(slots[i]); };
  const auto velocity = [&](std::size_t i) { return state.velocity.at(slots[i]); };
  if (fields_ == FrameFields::all)
  {
    add_field<vtkDoubleArray>(data, "displacement", "m", slots.size(), displacement);
    add_field<vtkDoubleArray>(data, "velocity", "m/s", slots.size(), velocity);
    add_fields(*frame, state, lattice_, material_, slots);
    add_bonds(*frame, state, lattice_, slots);
  }
  else
  {
    add_field<vtkFloatArray>(data, "displacement", "m", slots.size(), displacement);
    add_field<vtkFloatArray>(data, "velocity", "m/s", slots.size(), velocity);
    data.SetActiveScalars("displacement");
  }
  // Array that ParaView shows by default; velocities are zero at the start.
  data.SetActiveVectors("displacement");
  add_field<vtkDoubleArray>(*frame->GetFieldData(), "TimeValue", "s", 1, [&](std::size_t) { return state.time; });

  while (!times_.empty() && times_.back() >= state.time) // of a state that was restored after a failure
    times_.pop_back();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(frame);
  write_vtk_file(*writer, directory_ / file_name(times_.size()));
  times_.push_back(state.time);
  write_collection();
}

std::string FieldWriter::file_name(std::size_t frame) const
{
  return name_ + support::formatted("-%04zu.vtp", frame);
}

void FieldWriter::write_collection() const
{
  std::vector<support::PvdFile> files;
  for (std::size_t frame = 0; frame < times_.size(); ++frame)
    files.push_back({times_[frame], file_name(frame)});
  support::write_atomically(directory_ / (name_ + ".pvd"), support::pvd_text(files), support::Sync::no);
}

void write_near_tip_field(const analysis::NearTipField &field, const std::filesystem::path &path)
{
  const analysis::NearTipGrid &grid = field.grid;
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.columns(), grid.rows(), 1);
  image->SetSpacing(grid.pitch_X, grid.pitch_Y, 1.);
  image->SetOrigin(-grid.behind * grid.pitch_X, -grid.half_height * grid.pitch_Y, 0.);
  const auto add = [&](const char *name, const char *unit, const auto &values)
  {
    add_field<vtkDoubleArray>(*image->GetPointData(), name, unit, grid.size(),
                              [&](std::size_t i) { return values[i]; });
  };
  add("displacement", "m", field.displacement);
  add("excess_displacement", "m", field.excess_displacement);
  add("velocity", "m/s", field.velocity);
  add("deformation_gradient", "1", field.deformation_gradient);
  add("first_piola_stress", "Pa", field.first_piola_stress);
  add("cauchy_stress", "Pa", field.cauchy_stress);
  add("strain_gradient_x", "1/m", field.strain_gradient_x);
  add("strain_gradient_y", "1/m", field.strain_gradient_y);
  add("occupancy", "1", field.occupancy);
  add_field<vtkDoubleArray>(*image->GetFieldData(), "Samples", nullptr, 1, [&](std::size_t) { return field.samples; });

  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  write_vtk_file(*writer, path);
}

} // namespace latcon::output
