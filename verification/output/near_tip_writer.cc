#include "verification/output/near_tip_writer.h"

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>

#include "verification/output/point_data.h"
#include "verification/output/vtk_file.h"

namespace latcon::output
{

void write_near_tip_field(const analysis::NearTipField &field, const std::filesystem::path &path)
{
  const analysis::NearTipGrid &grid = field.grid;
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.columns(), grid.rows(), 1);
  image->SetSpacing(grid.pitch_X, grid.pitch_Y, 1.);
  image->SetOrigin(-grid.behind * grid.pitch_X, -grid.half_height * grid.pitch_Y, 0.);
  const auto add = [&](const char *name, const auto &values)
  {
    add_field<vtkDoubleArray>(*image->GetPointData(), name, grid.size(), [&](std::size_t i) { return values[i]; });
  };
  add("displacement", field.displacement);
  add("excess_displacement", field.excess_displacement);
  add("velocity", field.velocity);
  add("deformation_gradient", field.deformation_gradient);
  add("first_piola_stress", field.first_piola_stress);
  add("cauchy_stress", field.cauchy_stress);
  add("strain_gradient_x", field.strain_gradient_x);
  add("strain_gradient_y", field.strain_gradient_y);
  add("occupancy", field.occupancy);
  vtkNew<vtkDoubleArray> samples;
  samples->SetName("Samples");
  samples->InsertNextValue(static_cast<double>(field.samples));
  image->GetFieldData()->AddArray(samples);

  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  write_vtk_file(*writer, path);
}

} // namespace latcon::output
