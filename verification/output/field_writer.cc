#include "verification/output/field_writer.h"

#include <limits>
#include <optional>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include "lattice/site_fields.h"
#include "lattice/strain_gradient.h"
#include "verification/analysis/fragments.h"
#include "verification/output/point_data.h"

namespace latcon::output
{
namespace
{

using Slots = std::vector<std::size_t>; // of the points, in their order

void add_fields(vtkPolyData &frame, const lattice::State &state, const lattice::TriangularLattice &sheet,
                const lattice::Material &material, const Slots &slots)
{
  const lattice::SiteFields fields = site_fields(state, sheet, material);
  const analysis::Fragments fragments = analysis::find_fragments(state, sheet);
  lattice::StrainGradientFit gradient_fit(sheet);
  std::vector<lattice::StrainGradient> gradients;
  const Eigen::Matrix2d unknown = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const std::size_t slot : sheet.is_triangular() ? slots : Slots())
    gradients.push_back(gradient_fit.at(state, slot).value_or(lattice::StrainGradient{unknown, unknown}));
  vtkPointData &data = *frame.GetPointData();
  const auto add = [&](const char *name, const auto &of_slot)
  { add_field<vtkDoubleArray>(data, name, slots.size(), [&](std::size_t i) { return of_slot[slots[i]]; }); };
  add("deformation_gradient", fields.deformation_gradient);
  add("first_piola_stress", fields.first_piola_stress);
  add("cauchy_stress", fields.cauchy_stress);
  if (!gradients.empty())
  {
    add_field<vtkDoubleArray>(data, "strain_gradient_x", slots.size(), [&](std::size_t i) { return gradients[i].x; });
    add_field<vtkDoubleArray>(data, "strain_gradient_y", slots.size(), [&](std::size_t i) { return gradients[i].y; });
  }
  add("strain_energy_density", fields.strain_energy_density);
  add("damage", fields.damage);
  add_field<vtkUnsignedCharArray>(data, "held", slots.size(), [&](std::size_t i) { return state.held[slots[i]]; });
  add_field<vtkIdTypeArray>(data, "site", slots.size(), [&](std::size_t i) { return sheet.site_number(slots[i]); });
  add_field<vtkIdTypeArray>(data, "fragment", slots.size(), [&](std::size_t i) { return fragments.number[slots[i]]; });
  // The outermost sites of a periodic sheet are inside its ends.
  vtkNew<vtkDoubleArray> bounds;
  bounds->SetName("SheetBounds");
  bounds->SetNumberOfComponents(4);
  bounds->InsertNextTuple4(0., sheet.length(), -0.5 * sheet.height(), 0.5 * sheet.height());
  set_unit(*bounds);
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
  add_field<vtkDoubleArray>(data, "stretch", n, [&](std::size_t i) { return stretches[i]; });
  add_field<vtkUnsignedCharArray>(data, "shell", n, [&](std::size_t i) { return shells[i]; });
  add_field<vtkUnsignedCharArray>(data, "toughened", n, [&](std::size_t i) { return toughened[i]; });
  data.SetActiveScalars("stretch");
}

} // namespace

FieldWriter::FieldWriter(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         std::filesystem::path directory, std::string name, FrameFields fields)
  : lattice_(lattice), material_(material), fields_(fields), series_(std::move(directory), std::move(name))
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
  const auto displacement = [&](std::size_t i) -> Eigen::Vector2d {
    return Eigen::Vector2d(state.x[slots[i]], state.y[slots[i]]) - lattice_.reference(slots[i]);
  };
  const auto velocity = [&](std::size_t i) { return Eigen::Vector2d(state.vx[slots[i]], state.vy[slots[i]]); };
  if (fields_ == FrameFields::all)
  {
    add_field<vtkDoubleArray>(data, "displacement", slots.size(), displacement);
    add_field<vtkDoubleArray>(data, "velocity", slots.size(), velocity);
    add_fields(*frame, state, lattice_, material_, slots);
    add_bonds(*frame, state, lattice_, slots);
  }
  else
  {
    add_field<vtkFloatArray>(data, "displacement", slots.size(), displacement);
    add_field<vtkFloatArray>(data, "velocity", slots.size(), velocity);
    data.SetActiveScalars("displacement");
  }
  // Array that ParaView shows by default; velocities are zero at the start.
  data.SetActiveVectors("displacement");
  series_.add(*frame, state.time);
}

} // namespace latcon::output
