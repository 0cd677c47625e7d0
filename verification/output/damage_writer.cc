#include "verification/output/damage_writer.h"

#include <array>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "verification/output/point_data.h"

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
  const auto vector = [](const auto &components, std::size_t a)
  { return Eigen::Vector2d(components[0][a], components[1][a]); };
  vtkNew<vtkPoints> points;
  for (std::size_t a = 0; a < grid.n_nodes(); ++a)
    points->InsertNextPoint(grid.position(a)[0], grid.position(a)[1], 0.);
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
  vtkPointData &data = *sheet->GetPointData();
  const auto add = [&](const char *name, const auto &value)
  { add_field<vtkFloatArray>(data, name, grid.n_nodes(), value); };
  add("displacement",
      [&](std::size_t a) -> Eigen::Vector2d
      {
        const dealii::Tensor<1, 2> affine = loading_ * grid.position(a) - grid.position(a);
        return Eigen::Vector2d(affine[0], affine[1]) + vector(motion.displacement(), a);
      });
  add("velocity", [&](std::size_t a) { return vector(motion.velocity(), a); });
  add("damage", [&](std::size_t a) { return motion.damage().nodal()[a]; });
  const std::vector<double> densities = energy_densities(motion);
  add("strain_energy_density", [&](std::size_t a) { return densities[a]; });
  // Arrays that ParaView shows by default.
  data.SetActiveVectors("displacement");
  data.SetActiveScalars("damage");
  series_.add(*sheet, motion.time());
}

} // namespace latcon::output
