/// Fields that lattice and continuum frames have in common.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace latcon::compare
{

/// Field with the same name in lattice and continuum files.
struct CommonField
{
  const char *name; ///< name of the array in the files
  const char *unit;
  std::size_t components; ///< in-plane components: 1 scalar, 2 vector, 4 tensor by rows
  bool from_bonds;        ///< on the lattice, a sum or fit over the bonds of a site, so incomplete if bonds are missing
  bool in_motion_only;    ///< continuum frames have it only in motion
};

/// All common fields, in the order of the tables.
inline constexpr std::array<CommonField, 6> common_fields{{{"displacement", "m", 2, false, false},
                                                           {"velocity", "m/s", 2, false, true},
                                                           {"deformation_gradient", "1", 4, true, false},
                                                           {"first_piola_stress", "Pa", 4, true, false},
                                                           {"cauchy_stress", "Pa", 4, true, false},
                                                           {"strain_energy_density", "J/m^3", 1, true, false}}};

/// Values of a field at points; the components of a point are contiguous.
struct FieldValues
{
  const CommonField *field;
  std::vector<double> values;

  const double *at(std::size_t point) const { return values.data() + point * field->components; }
};

/// Position in the plane [m].
using Position = std::array<double, 2>;

} // namespace latcon::compare
