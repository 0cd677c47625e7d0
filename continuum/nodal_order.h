#pragma once

#include "continuum/sheet.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// The nodal values of a sheet in an order that does not depend on how ranks share the mesh: cell after cell by their
/// places in the tree of refinements, every unknown where it is met first. So a state that some ranks store is one that
/// any number of ranks takes up. Of use until the sheet numbers its unknowns anew.
class NodalOrder
{
public:
  /// `sheet` must outlive the order. Collective.
  explicit NodalOrder(const Sheet &sheet);

  /// The values of a nodal vector, with or without ghost entries: all on the first rank, none on others. Collective.
  std::vector<double> gathered(const Sheet::Vector &x) const;

  /// Gives the nodal vector `x` the values, all of which every rank has to know. Collective. Throws InvalidInput unless
  /// there is one for every unknown.
  void spread(const std::vector<double> &values, Sheet::Vector &x) const;

  /// Stores a nodal vector in an archive, or takes it from there.
  template <class Archive>
  void archive(Archive &archive, const std::string &name, Sheet::Vector &x) const
  {
    std::vector<double> values;
    if constexpr (!Archive::loads)
      values = gathered(x);
    archive(name, values);
    if constexpr (Archive::loads)
      spread(values, x);
  }

private:
  const Sheet &sheet_;
  std::vector<unsigned int> place_; // of each owned unknown in the order; on the first rank of each unknown
};
} // namespace latcon::continuum
