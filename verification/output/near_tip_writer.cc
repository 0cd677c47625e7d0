#include "verification/output/near_tip_writer.h"

#include <string>

#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkXMLImageDataWriter.h>

#include "verification/output/field_units.h"
#include "verification/output/vtk_file.h"

namespace latcon::output
{
namespace
{

// Adds an array with a number of `components` per point; fill(array, id, point) sets a tuple.
template <typename Fill>
void add(vtkImageData &image, const char *name, int components, std::size_t points, const Fill &fill)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  set_unit(*array);
  array->SetNumberOfTuples(static_cast<vtkIdType>(points));
  for (std::size_t point = 0; point < points; ++point)
    fill(*array, static_cast<vtkIdType>(point), point);
  image.GetPointData()->AddArray(array);
}

void add(vtkImageData &image, const char *name, const std::vector<Eigen::Vector2d> &vectors)
{
  add(image, name, 3, vectors.size(),
      [&](vtkDoubleArray &array, vtkIdType id, std::size_t point)
      { array.SetTuple3(id, vectors[point].x(), vectors[point].y(), 0.); });
}

void add(vtkImageData &image, const char *name, const lattice::TensorField &tensors)
{
  add(image, name, 9, tensors.size(),
      [&](vtkDoubleArray &array, vtkIdType id, std::size_t point)
      {
        const Eigen::Matrix2d &t = tensors[point];
        array.SetTuple9(id, t(0, 0), t(0, 1), 0., t(1, 0), t(1, 1), 0., 0., 0., 0.);
      });
}

} // namespace

void write_near_tip_field(const analysis::NearTipField &field, const std::filesystem::path &path)
{
  const analysis::NearTipGrid &grid = field.grid;
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.columns(), grid.rows(), 1);
  image->SetSpacing(grid.pitch_X, grid.pitch_Y, 1.);
  image->SetOrigin(-grid.behind * grid.pitch_X, -grid.half_height * grid.pitch_Y, 0.);
  add(*image, "displacement", field.displacement);
  add(*image, "excess_displacement", field.excess_displacement);
  add(*image, "velocity", field.velocity);
  add(*image, "deformation_gradient", field.deformation_gradient);
  add(*image, "first_piola_stress", field.first_piola_stress);
  add(*image, "cauchy_stress", field.cauchy_stress);
  add(*image, "strain_gradient_x", field.strain_gradient_x);
  add(*image, "strain_gradient_y", field.strain_gradient_y);
  add(*image, "occupancy", 1, grid.size(),
      [&](vtkDoubleArray &array, vtkIdType id, std::size_t point) { array.SetValue(id, field.occupancy[point]); });
  vtkNew<vtkDoubleArray> samples;
  samples->SetName("Samples");
  samples->InsertNextValue(static_cast<double>(field.samples));
  image->GetFieldData()->AddArray(samples);

  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputData(image);
  write_vtk_file(*writer, path);
}

} // namespace latcon::output
