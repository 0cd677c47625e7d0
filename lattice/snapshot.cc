#include "lattice/snapshot.h"

#include <algorithm>

namespace latcon::lattice
{
namespace
{

// The places of the rows of a band follow each other.
Rows places(const RowPartition &band)
{
  const TriangularLattice &lattice = band.lattice();
  const Rows rows = band.rows();
  if (rows.begin == rows.end)
    return {0, 0};
  return {lattice.index(rows.begin, 0), lattice.index(rows.end - 1, 0) + lattice.columns()};
}

} // namespace

Snapshot::Snapshot(const State &state, const RowPartition &band) : time_(state.time)
{
  const Rows range = places(band);
  const auto copy = [&](const auto *from, auto &to) { to.assign(from + range.begin, from + range.end); };
  copy(state.x.data(), x_);
  copy(state.y.data(), y_);
  copy(state.vx.data(), vx_);
  copy(state.vy.data(), vy_);
  copy(state.bonds.words(), bonds_[0]);
  if (const BondStates::Word *third = state.bonds.words(BondStates::kinds_per_word))
    copy(third, bonds_[1]);
  copy(state.lost_bonds.data(), lost_bonds_);
}

void Snapshot::put_into(State &state, const RowPartition &band) const
{
  const auto begin = static_cast<std::ptrdiff_t>(places(band).begin);
  const auto copy = [&](const auto &from, auto &to) { std::copy(from.begin(), from.end(), to.begin() + begin); };
  state.time = time_;
  copy(x_, state.x);
  copy(y_, state.y);
  copy(vx_, state.vx);
  copy(vy_, state.vy);
  for (std::size_t i = 0; i < bonds_.size(); ++i)
    copy(bonds_[i], state.bonds.storage()[i]);
  copy(lost_bonds_, state.lost_bonds);
}

} // namespace latcon::lattice
