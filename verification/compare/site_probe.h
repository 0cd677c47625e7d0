/// Values of a finite element field at points.
#pragma once

#include <cstdint>
#include <vector>

#include <mpi.h>

#include "verification/compare/frame.h"

namespace latcon::compare
{

/// Finds the cells at a point and interpolates between their nodes. Positions of curved cells are inverted by Newton's
/// method, so that a polynomial of the cells' degree is found again to the precision of the file.
///
/// @note The frame must outlive it.
class SiteProbe
{
public:
  /// @param tolerance how far outside a cell a point may be and still belong to it [m]
  SiteProbe(const ContinuumFrame &frame, double tolerance);

  /// Number of values at a point: the components of all fields of the frame.
  std::size_t n_values() const { return n_values_; }

  /// Fields at a point one after another, the mean over the cells that meet there, since derivatives jump between
  /// cells.
  /// @return false if the point is in no cell; then the values are left as they are
  bool evaluate(const Position &point, double *values) const;

private:
  bool find_in_cell(const Cell &cell, const Position &point, Position &unit) const;
  std::size_t bin(std::size_t axis, double coordinate) const;

  const ContinuumFrame &frame_;
  double tolerance_;
  std::size_t n_values_ = 0;
  struct Box
  {
    Position low, high;
  };
  std::vector<Box> boxes_; // of the cells
  Box whole_;
  std::array<std::size_t, 2> n_bins_{};
  std::vector<std::vector<std::size_t>> bins_; // cells whose boxes meet a bin
};

/// Fields of a continuum frame at points.
struct SiteValues
{
  std::vector<std::uint8_t> outside; ///< 1 at points that are in no cell
  std::vector<FieldValues> fields;   ///< not-a-number at points outside
};

/// Values at points, which are shared over the ranks. All ranks have the whole frame and get all values, the same bits
/// for any number of ranks. Collective.
/// @param tolerance see SiteProbe
SiteValues probe(const ContinuumFrame &frame, const std::vector<Position> &points, double tolerance,
                 MPI_Comm communicator);

} // namespace latcon::compare
