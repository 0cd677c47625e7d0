#pragma once

#include <filesystem>
#include <vector>

#include "continuum/damage/damage_motion.h"
#include "verification/analysis/damage_contour.h"
#include "verification/input/case.h"
#include "verification/output/histories.h"

namespace latcon::output
{

/// Record of a crack of the continuum: positions of its tip, energies over time. Its edge is the
/// contour of damage 0.5. Units and configuration as in analysis::TipRecord.
class DamageRecord
{
public:
  /// @param motion at its first step; must outlive the record
  /// @param seed_tip reference X of the right end of the seed [m]
  DamageRecord(const input::Case &input, const continuum::DamageMotion &motion, double seed_tip);

  /// Records the tip, after a step or before the first.
  void step();

  /// Records the energies.
  void energies();

  const TipHistory &tip() const { return tip_; }

  /// Returns the mean Lagrangian speed of the tip since the start [m/s]; 0 before the first step.
  double mean_speed() const;

  /// Returns the imbalance of the recorded energies, see LedgerCheck::imbalance().
  double imbalance() const;

  analysis::CrackMeasurement measure() const;

  /// Writes crack.csv, crack_edges.csv and energy.csv. @throws OutputError
  void write_tables(const std::filesystem::path &directory) const;

  /// Writes crack.json. @param skip_verification true if the material was not verified @throws OutputError
  void write_measurement(const std::filesystem::path &directory, const analysis::CrackMeasurement &measurement,
                         bool skip_verification) const;

  /// Saves or loads the record; the motion must be loaded first. @throws std::invalid_argument for records that do not
  /// belong to it
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("column", column_);
    tip_.archive(archive, motion_.time());
    energies_.archive(archive, motion_.time());
    if constexpr (Archive::loads)
      lattice::require_archived(column_ < motion_.grid().columns(), "`column` is outside the sheet");
  }

private:
  analysis::DamageImage image() const;

  const input::Case &input_;
  const continuum::DamageMotion &motion_;
  double seed_tip_;    // [m]
  std::size_t column_; // of nodes, that the tip has reached
  TipHistory tip_;
  EnergyHistory<continuum::DamageMotionLedger> energies_;
};

} // namespace latcon::output
