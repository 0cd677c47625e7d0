/// Evaluation of finite element fields at points.
#pragma once

#include <cstdint>
#include <vector>

#include <mpi.h>

#include "verification/compare/frame.h"

namespace latcon::compare
{

/// Finds the cells at a point and interpolates between their nodes. Newton's method inverts the mapping of curved
/// cells, so that polynomials of the degree of the cells are reproduced to the precision of the file.
///
/// The frame must outlive this object.
class SiteProbe
{
public:
  /// @param tolerance distance outside a cell up to which a point belongs to it [m]
  SiteProbe(const ContinuumFrame &frame, double tolerance);

  /// Returns the number of values at a point: components of all fields of the frame.
  std::size_t n_values() const { return n_values_; }

  /// Evaluates all fields at a point, one after another. On cell boundaries it takes the mean over the adjacent cells,
  /// because derivatives jump between cells.
  /// @return false if the point is in no cell; the values are then unchanged
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
  std::vector<Box> boxes_; // bounding boxes of the cells
  Box whole_;
  std::array<std::size_t, 2> n_bins_{};
  std::vector<std::vector<std::size_t>> bins_; // cells whose boxes overlap a bin
};

/// Fields of a continuum frame at points.
struct SiteValues
{
  std::vector<std::uint8_t> outside; ///< 1 at points that are in no cell
  std::vector<FieldValues> fields;   ///< NaN at points outside
};

/// Evaluates a frame at points, which are distributed over the ranks. All ranks pass the whole frame and get all
/// values. The result does not depend on the number of ranks. Collective.
/// @param tolerance see SiteProbe
SiteValues probe(const ContinuumFrame &frame, const std::vector<Position> &points, double tolerance,
                 MPI_Comm communicator);

} // namespace latcon::compare
