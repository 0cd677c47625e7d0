#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/tria_iterator.h>

namespace latcon::continuum
{
/// Factor of the stored energy that depends on the reference position, such as the degradation of a damage field
/// (theory-damage.md, eq. (C.60)). It multiplies every term of the functional (C.28) at a point: W, W_g and the
/// terms on faces, and therefore stress, double stress and tangents.
class StiffnessFactor
{
public:
  virtual ~StiffnessFactor() = default;

  /// Returns the factor [-], positive, at a point of a cell that is on this rank (owned or ghost). It must be
  /// continuous across cells.
  /// @param unit_point coordinates in the reference cell, each in [0, 1]
  virtual double at(const dealii::Triangulation<2>::cell_iterator &cell, const dealii::Point<2> &unit_point) const = 0;
};
} // namespace latcon::continuum
