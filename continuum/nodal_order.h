#pragma once

#include "continuum/sheet.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// Order of the nodal values of a sheet that does not depend on the partition of the mesh: cells in the order of the
/// refinement tree, each unknown at its first occurrence. A state saved on some number of ranks can thus be loaded on
/// any other. Valid until the next Sheet::distribute().
class NodalOrder
{
public:
  /// `sheet` must outlive the order. Collective.
  explicit NodalOrder(const Sheet &sheet);

  /// Gathers the values of a nodal vector, with or without ghost entries, on the root rank; returns an empty list on
  /// other ranks. Collective.
  std::vector<double> gather(const Sheet::Vector &x) const;

  /// Sets the nodal vector `x` from the complete list of values, which must be the same on every rank. Collective.
  /// Throws InvalidInput if the number of values is not the number of unknowns.
  void scatter(const std::vector<double> &values, Sheet::Vector &x) const;

  /// Saves a nodal vector to an archive or loads it from there.
  template <class Archive>
  void archive(Archive &archive, const std::string &name, Sheet::Vector &x) const
  {
    std::vector<double> values;
    if constexpr (!Archive::loads)
      values = gather(x);
    archive(name, values);
    if constexpr (Archive::loads)
      scatter(values, x);
  }

private:
  const Sheet &sheet_;
  std::vector<unsigned int> position_; // in the order, of each owned unknown; on the root rank of each unknown
};
} // namespace latcon::continuum
