#pragma once

// Point data of frames, on a grid, a lattice or the nodes of a mesh; private to the sources that write VTK files.

#include <string>
#include <type_traits>
#include <utility>

#include <Eigen/Core>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>

namespace latcon::output
{

/// Sets the unit of a field according to its name, as VTK's `UNITS_LABEL`. Fields that are not quantities get none.
inline void set_unit(vtkDataArray &field)
{
  static constexpr std::pair<const char *, const char *> units[] = {{"displacement", "m"},
                                                                    {"excess_displacement", "m"},
                                                                    {"velocity", "m/s"},
                                                                    {"deformation_gradient", "1"},
                                                                    {"first_piola_stress", "Pa"},
                                                                    {"cauchy_stress", "Pa"},
                                                                    {"strain_gradient_x", "1/m"},
                                                                    {"strain_gradient_y", "1/m"},
                                                                    {"strain_energy_density", "J/m^3"},
                                                                    {"damage", "1"},
                                                                    {"stretch", "1"},
                                                                    {"occupancy", "1"},
                                                                    {"TimeValue", "s"},
                                                                    {"SheetBounds", "m"}};
  for (const auto &[name, unit] : units)
    if (field.GetName() == std::string(name))
      field.GetInformation()->Set(vtkDataArray::UNITS_LABEL(), unit);
}

/// Appends a field with its unit to the data of n points, cells, or a whole frame. ParaView expects three components of
/// vectors and nine of tensors.
/// @param value called with a point's index; returns a number, Eigen::Vector2d or Eigen::Matrix2d
template <class Array, class Value>
void add_field(vtkFieldData &data, const char *name, std::size_t n, const Value &value)
{
  using T = std::decay_t<decltype(value(n))>;
  constexpr bool is_vector = std::is_same_v<T, Eigen::Vector2d>, is_tensor = std::is_same_v<T, Eigen::Matrix2d>;
  vtkNew<Array> field;
  field->SetName(name);
  field->SetNumberOfComponents(is_tensor ? 9 : is_vector ? 3 : 1);
  field->SetNumberOfTuples(static_cast<vtkIdType>(n));
  set_unit(*field);
  for (std::size_t i = 0; i < n; ++i)
  {
    const T v = value(i);
    const auto id = static_cast<vtkIdType>(i);
    if constexpr (is_tensor)
      field->SetTuple9(id, v(0, 0), v(0, 1), 0., v(1, 0), v(1, 1), 0., 0., 0., 0.);
    else if constexpr (is_vector)
      field->SetTuple3(id, v.x(), v.y(), 0.);
    else
      field->SetValue(id, static_cast<typename Array::ValueType>(v));
  }
  data.AddArray(field);
}

} // namespace latcon::output
