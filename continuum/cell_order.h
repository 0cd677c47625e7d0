#pragma once

#include "continuum/sheet.h"

#include <string>
#include <vector>

namespace latcon::continuum
{
/// Order of the cells of a sheet that does not depend on the partition of the mesh: that of their names in the
/// refinement tree. Values at quadrature points saved on some number of ranks can thus be loaded on any other. Valid
/// until the mesh changes.
class CellOrder
{
public:
  /// Creates the order for lists of `n_values` values per locally owned cell, in the order of their iteration.
  /// Collective.
  CellOrder(const Sheet &sheet, const std::vector<std::size_t> &n_values);

  /// Gathers the lists of the locally owned cells on the root rank; returns an empty list on other ranks. Collective.
  /// @tparam Value double or dealii::types::global_dof_index
  template <class Value>
  std::vector<Value> gather(const std::vector<Value> &own) const;

  /// Returns the values of the locally owned cells from the complete list, which must be the same on every rank. Throws
  /// InvalidInput on every rank if the list does not have the values of all cells.
  std::vector<double> scatter(const std::vector<double> &all) const;

private:
  // Values of a locally owned cell: their beginning in the complete list, and their number.
  using Range = std::pair<std::size_t, std::size_t>;

  MPI_Comm communicator_;
  std::size_t n_values_ = 0;  // of all cells
  std::vector<Range> ranges_; // of each locally owned cell
};

/// Order of the nodal values of a sheet that does not depend on the partition of the mesh: cells in CellOrder, each
/// unknown at its first occurrence. Valid until the next Sheet::distribute().
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
  std::vector<unsigned int> position_; // of each unknown in the order
};
} // namespace latcon::continuum
