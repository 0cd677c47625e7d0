#include "verification/output/damage_writer.h"

#include <array>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "verification/output/field_units.h"

namespace latcon::output
{
namespace
{

// Means over the cells at each node of their degraded energy densities [J/m^3].
std::vector<double> energy_densities(const continuum::DamageMotion &motion)
{
  const continuum::NodeGrid &grid = motion.grid();
  std::vector<double> sum(grid.n_nodes(), 0.), cells(grid.n_nodes(), 0.);
  for (std::size_t j = 0; j < grid.cells_y; ++j)
    for (std::size_t i = 0; i < grid.cells_x; ++i)
    {
      const std::size_t c = j * grid.cells_x + i, a = j * grid.columns() + i;
      for (const std::size_t b : {a, a + 1, a + grid.columns(), a + grid.columns() + 1})
      {
        sum[b] += motion.damage().cell_factors()[c] * motion.cell_energies()[c] / grid.area();
        cells[b] += 1.;
      }
    }
  for (std::size_t a = 0; a < sum.size(); ++a)
    sum[a] /= cells[a];
  return sum;
}

} // namespace

DamageWriter::DamageWriter(std::filesystem::path directory, const dealii::Tensor<2, 2> &loading)
  : series_(std::move(directory), "continuum"), loading_(loading)
{
}

void DamageWriter::add_frame(const continuum::DamageMotion &motion)
{
  const continuum::NodeGrid &grid = motion.grid();
  const auto n = static_cast<vtkIdType>(grid.n_nodes());
  const auto array = [n](const char *name, int components)
  {
    vtkNew<vtkFloatArray> values;
    values->SetName(name);
    values->SetNumberOfComponents(components);
    values->SetNumberOfTuples(n);
    set_unit(*values);
    return values;
  };
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(n);
  const auto displacement = array("displacement", 3), velocity = array("velocity", 3);
  const auto damage = array("damage", 1), energy = array("strain_energy_density", 1);
  const std::vector<double> densities = energy_densities(motion);
  for (vtkIdType id = 0; id < n; ++id)
  {
    const auto a = static_cast<std::size_t>(id);
    const dealii::Point<2> X = grid.position(a);
    const dealii::Tensor<1, 2> affine = loading_ * X - X;
    points->SetPoint(id, X[0], X[1], 0.);
    displacement->SetTuple3(id, affine[0] + motion.displacement()[0][a], affine[1] + motion.displacement()[1][a], 0.);
    velocity->SetTuple3(id, motion.velocity()[0][a], motion.velocity()[1][a], 0.);
    damage->SetValue(id, static_cast<float>(motion.damage().nodal()[a]));
    energy->SetValue(id, static_cast<float>(densities[a]));
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t j = 0; j < grid.cells_y; ++j)
    for (std::size_t i = 0; i < grid.cells_x; ++i)
    {
      const auto a = static_cast<vtkIdType>(j * grid.columns() + i), up = static_cast<vtkIdType>(grid.columns());
      const std::array<vtkIdType, 4> corners{{a, a + 1, a + up + 1, a + up}};
      cells->InsertNextCell(4, corners.data());
    }
  vtkNew<vtkPolyData> sheet;
  sheet->SetPoints(points);
  sheet->SetPolys(cells);
  for (vtkFloatArray *data : {displacement.Get(), velocity.Get(), damage.Get(), energy.Get()})
    sheet->GetPointData()->AddArray(data);
  // Arrays that ParaView shows by default.
  sheet->GetPointData()->SetActiveVectors(displacement->GetName());
  sheet->GetPointData()->SetActiveScalars(damage->GetName());
  series_.add(*sheet, motion.time());
}

} // namespace latcon::output
