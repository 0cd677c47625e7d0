#include "verification/output/motion_writer.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include "verification/output/field_units.h"

namespace latcon::output
{

MotionWriter::MotionWriter(const lattice::TriangularLattice &lattice, std::filesystem::path directory)
  : lattice_(lattice), series_(std::move(directory), "motion")
{
}

void MotionWriter::add_frame(const lattice::State &state)
{
  vtkNew<vtkPoints> points; // in single precision
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkFloatArray> displacement, velocity;
  displacement->SetName("displacement");
  velocity->SetName("velocity");
  for (vtkFloatArray *vectors : {displacement.Get(), velocity.Get()})
  {
    vectors->SetNumberOfComponents(3);
    set_unit(*vectors);
  }
  for (std::size_t row = 0; row < lattice_.rows(); ++row)
    for (std::size_t column = 0; column < lattice_.sites_in_row(row); ++column)
    {
      const std::size_t place = lattice_.index(row, column);
      if (state.removed[place] != 0)
        continue;
      const Eigen::Vector2d reference = lattice_.reference(place);
      const vtkIdType id = points->InsertNextPoint(reference.x(), reference.y(), 0.);
      vertices->InsertNextCell(1, &id);
      displacement->InsertNextTuple3(state.x[place] - reference.x(), state.y[place] - reference.y(), 0.);
      velocity->InsertNextTuple3(state.vx[place], state.vy[place], 0.);
    }
  vtkNew<vtkPolyData> sheet;
  sheet->SetPoints(points);
  sheet->SetVerts(vertices);
  sheet->GetPointData()->AddArray(displacement);
  sheet->GetPointData()->AddArray(velocity);
  // Array that ParaView shows by default; velocities are zero at the start.
  sheet->GetPointData()->SetActiveScalars(displacement->GetName());
  sheet->GetPointData()->SetActiveVectors(displacement->GetName());
  series_.add(*sheet, state.time);
}

} // namespace latcon::output
