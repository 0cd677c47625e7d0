#pragma once

#include <cstddef>

namespace latcon::analysis
{

/// Position of the crack tip. There is one record per move of the tip; between records it rests.
struct TipRecord
{
  double t;    ///< time [s], not decreasing along a record
  double X, Y; ///< reference position [m], X not decreasing along a record
  double x, y; ///< current position at time t [m]
  std::size_t n_broken = 0; ///< bonds broken so far

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("t", t);
    archive("X", X);
    archive("Y", Y);
    archive("x", x);
    archive("y", y);
    archive("n_broken", n_broken);
  }
};

/// Record of one broken bond.
struct BreakRecord
{
  double t; ///< time of breaking [s]
  double X; ///< reference midpoint [m]
  double Y; ///< reference midpoint [m]
};

} // namespace latcon::analysis
