#include "verification/output/field_writer.h"

#include <limits>
#include <optional>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>

#include "lattice/site_fields.h"
#include "lattice/strain_gradient.h"
#include "verification/analysis/fragments.h"
#include "verification/output/field_units.h"

namespace latcon::output
{
namespace
{

vtkNew<vtkDoubleArray> array(const char *name, int components, vtkIdType tuples)
{
  vtkNew<vtkDoubleArray> values;
  values->SetName(name);
  values->SetNumberOfComponents(components);
  values->SetNumberOfTuples(tuples);
  set_unit(*values);
  return values;
}

// ParaView expects three components for vectors and nine for tensors.
void set_vector(vtkDoubleArray &values, vtkIdType id, double x, double y)
{
  values.SetTuple3(id, x, y, 0.);
}

void set_tensor(vtkDoubleArray &values, vtkIdType id, const Eigen::Matrix2d &t)
{
  values.SetTuple9(id, t(0, 0), t(0, 1), 0., t(1, 0), t(1, 1), 0., 0., 0., 0.);
}

} // namespace

FieldWriter::FieldWriter(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                         std::filesystem::path directory, std::string name)
  : lattice_(lattice), material_(material), series_(std::move(directory), std::move(name))
{
}

void FieldWriter::add_frame(const lattice::State &state)
{
  std::vector<std::size_t> places; // slots of the points, in their order
  std::vector<vtkIdType> point_of_place(lattice_.n_places(), -1);
  for (std::size_t row = 0; row < lattice_.rows(); ++row)
    for (std::size_t column = 0; column < lattice_.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice_.index(row, column);
      if (state.removed[place] != 0)
        continue;
      point_of_place[place] = static_cast<vtkIdType>(places.size());
      places.push_back(place);
    }
  const auto n_points = static_cast<vtkIdType>(places.size());

  const lattice::SiteFields fields = site_fields(state, lattice_, material_);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(n_points);
  vtkNew<vtkCellArray> vertices;
  const auto displacement = array("displacement", 3, n_points);
  const auto velocity = array("velocity", 3, n_points);
  const auto deformation_gradient = array("deformation_gradient", 9, n_points);
  const auto first_piola_stress = array("first_piola_stress", 9, n_points);
  const auto cauchy_stress = array("cauchy_stress", 9, n_points);
  const auto strain_gradient_x = array("strain_gradient_x", 9, n_points);
  const auto strain_gradient_y = array("strain_gradient_y", 9, n_points);
  lattice::StrainGradientFit gradient_fit(lattice_);
  const Eigen::Matrix2d unknown = Eigen::Matrix2d::Constant(std::numeric_limits<double>::quiet_NaN());
  const auto strain_energy_density = array("strain_energy_density", 1, n_points);
  const auto damage = array("damage", 1, n_points);
  vtkNew<vtkUnsignedCharArray> held;
  held->SetName("held");
  held->SetNumberOfTuples(n_points);
  vtkNew<vtkIdTypeArray> site;
  site->SetName("site");
  site->SetNumberOfTuples(n_points);
  vtkNew<vtkIdTypeArray> fragment;
  fragment->SetName("fragment");
  fragment->SetNumberOfTuples(n_points);
  const analysis::Fragments fragments = analysis::find_fragments(state, lattice_);
  for (vtkIdType id = 0; id < n_points; ++id)
  {
    const std::size_t place = places[static_cast<std::size_t>(id)];
    const Eigen::Vector2d reference = lattice_.reference(place);
    points->SetPoint(id, reference.x(), reference.y(), 0.);
    vertices->InsertNextCell(1, &id);
    set_vector(*displacement, id, state.x[place] - reference.x(), state.y[place] - reference.y());
    set_vector(*velocity, id, state.vx[place], state.vy[place]);
    set_tensor(*deformation_gradient, id, fields.deformation_gradient[place]);
    set_tensor(*first_piola_stress, id, fields.first_piola_stress[place]);
    set_tensor(*cauchy_stress, id, fields.cauchy_stress[place]);
    const std::optional<lattice::StrainGradient> gradient = gradient_fit.at(state, place);
    set_tensor(*strain_gradient_x, id, gradient ? gradient->x : unknown);
    set_tensor(*strain_gradient_y, id, gradient ? gradient->y : unknown);
    strain_energy_density->SetValue(id, fields.strain_energy_density[place]);
    damage->SetValue(id, fields.damage[place]);
    held->SetValue(id, state.held[place]);
    site->SetValue(id, static_cast<vtkIdType>(lattice_.site_number(place)));
    fragment->SetValue(id, static_cast<vtkIdType>(fragments.number[place]));
  }

  vtkNew<vtkCellArray> lines;
  const auto bond_stretch = array("stretch", 1, 0);
  vtkNew<vtkUnsignedCharArray> shell, toughened;
  shell->SetName("shell");
  toughened->SetName("toughened");
  // Cell data has the vertices first, then the lines. A site gets the mean of its bonds, so that it has the colour of
  // its surroundings.
  for (vtkIdType id = 0; id < n_points; ++id)
  {
    bond_stretch->InsertNextValue(0.);
    shell->InsertNextValue(0);
    toughened->InsertNextValue(0);
  }
  std::vector<unsigned int> bonds_of_point(static_cast<std::size_t>(n_points), 0);
  for_each_bond(state, lattice_,
                [&](const lattice::Bond &bond)
                {
                  if (point_of_place[bond.far] < 0)
                    return; // across a periodic edge: it would be drawn as a line through the whole sheet
                  const std::array<vtkIdType, 2> ends{{point_of_place[bond.near], point_of_place[bond.far]}};
                  lines->InsertNextCell(2, ends.data());
                  const double value = stretch(state, lattice_, bond);
                  bond_stretch->InsertNextValue(value);
                  for (const vtkIdType end : ends)
                  {
                    bond_stretch->SetValue(end, bond_stretch->GetValue(end) + value);
                    ++bonds_of_point[static_cast<std::size_t>(end)];
                  }
                  shell->InsertNextValue(static_cast<unsigned char>(lattice::shell_of(bond.kind) + 1));
                  toughened->InsertNextValue(state.bonds.toughened(bond.near, bond.kind) ? 1 : 0);
                });

  for (vtkIdType id = 0; id < n_points; ++id)
  {
    const unsigned int bonds = bonds_of_point[static_cast<std::size_t>(id)];
    bond_stretch->SetValue(id, bonds > 0 ? bond_stretch->GetValue(id) / bonds : 1.);
  }

  vtkNew<vtkPolyData> sheet;
  sheet->SetPoints(points);
  sheet->SetVerts(vertices);
  sheet->SetLines(lines);
  for (vtkDataArray *data :
       {static_cast<vtkDataArray *>(displacement.Get()), static_cast<vtkDataArray *>(velocity.Get()),
        static_cast<vtkDataArray *>(deformation_gradient.Get()), static_cast<vtkDataArray *>(first_piola_stress.Get()),
        static_cast<vtkDataArray *>(cauchy_stress.Get()), static_cast<vtkDataArray *>(strain_gradient_x.Get()),
        static_cast<vtkDataArray *>(strain_gradient_y.Get()), static_cast<vtkDataArray *>(strain_energy_density.Get()),
        static_cast<vtkDataArray *>(damage.Get()), static_cast<vtkDataArray *>(held.Get()),
        static_cast<vtkDataArray *>(site.Get()), static_cast<vtkDataArray *>(fragment.Get())})
    sheet->GetPointData()->AddArray(data);
  for (vtkDataArray *data : {static_cast<vtkDataArray *>(bond_stretch.Get()), static_cast<vtkDataArray *>(shell.Get()),
                             static_cast<vtkDataArray *>(toughened.Get())})
    sheet->GetCellData()->AddArray(data);
  // Arrays that ParaView shows by default.
  sheet->GetPointData()->SetActiveVectors(displacement->GetName());
  sheet->GetCellData()->SetActiveScalars(bond_stretch->GetName());
  // The outermost sites of a periodic sheet are inside its ends.
  const auto bounds = array("SheetBounds", 4, 1);
  bounds->SetTuple4(0, 0., lattice_.length(), -0.5 * lattice_.height(), 0.5 * lattice_.height());
  sheet->GetFieldData()->AddArray(bounds);

  series_.add(*sheet, state.time);
}

} // namespace latcon::output
