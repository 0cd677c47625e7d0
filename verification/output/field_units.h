#pragma once

// Units of the fields in VTK files; private to the sources that write them.

#include <string>
#include <utility>

#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>

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

} // namespace latcon::output
