#pragma once

#include <vector>

#include "lattice/state.h"

namespace latcon::lattice
{

/// Positions, velocities and bonds of a sheet at an instant, in the rows that a rank moves.
class Snapshot
{
public:
  Snapshot() = default;
  Snapshot(const State &state, const RowPartition &band);

  /// Puts the rows back into a state, for who looks at it: what else is needed to go on from there is not kept.
  void put_into(State &state, const RowPartition &band) const;

  double time() const { return time_; } ///< [s]

private:
  double time_ = 0.;
  std::vector<double> x_, y_, vx_, vy_;                // of the places of these rows, margin of columns included
  std::array<std::vector<BondStates::Word>, 2> bonds_; // as BondStates stores them
  std::vector<std::uint8_t> lost_bonds_;
};

} // namespace latcon::lattice
