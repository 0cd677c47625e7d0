#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/simulation.h"
#include "verification/analysis/crack_measurement.h"
#include "verification/input/case.h"
#include "verification/output/histories.h"
#include "verification/output/output_file.h"

namespace latcon::output
{

/// Record of a fracture run: positions of the crack tip, broken bonds, energies over time. All ranks have the same
/// record.
class CrackRecord
{
public:
  /// @param step_entry entry of the case that the time step depends on, which messages name
  CrackRecord(lattice::Simulation &simulation, std::string step_entry);

  /// Records the state before the first step. Collective.
  void start();

  /// Records a step. Collective. @param broken bonds that broke in this step
  void step(const std::vector<lattice::BrokenBond> &broken);

  /// Records the current energies. Collective. @throws SolverError as check() does
  void energies();

  /// Checks the energies of the sheet and stores a snapshot of the state. Collective.
  /// @throws SolverError if the energies are not finite or exceed the available energy, with time and position of the
  /// failure; the simulation then is back at the last valid state (see lattice::Simulation::restore)
  void check() { (void)checked_energies(); }

  const TipHistory &tip() const { return tip_; }
  /// Returns the imbalance of the recorded energies, see LedgerCheck::imbalance().
  double imbalance() const;

  analysis::CrackMeasurement measure(double seed_tip_X) const;

  /// Returns crack.csv, broken_bonds.csv and energy.csv.
  TextFiles tables(const std::filesystem::path &directory) const;

  /// Writes crack.json. Collective; the root rank writes.
  /// @param seed_tip_X reference X of the tip of the seed [m]
  /// @param skip_verification true if the material was not verified @throws OutputError
  void write_measurement(const std::filesystem::path &directory, const analysis::CrackMeasurement &measurement,
                         double seed_tip_X, const input::Case &input, bool skip_verification);

  /// Saves or loads the record; see lattice::Simulation. The state of the simulation, which must be loaded first,
  /// counts as valid, because checkpoints are written of valid states only. @throws std::invalid_argument for records
  /// that do not belong to this sheet
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("last_tip", last_tip_);
    tip_.archive(archive, simulation_.state().time);
    archive.records("broken_bonds", broken_);
    energies_.archive(archive, simulation_.state().time);
    if constexpr (Archive::loads)
      check_loaded();
    simulation_.save(last_valid_state_);
  }

private:
  void check_loaded() const;
  void record_tip();
  lattice::EnergyBalance checked_energies();

  lattice::Simulation &simulation_;
  std::string step_entry_;
  std::optional<std::size_t> last_tip_;
  TipHistory tip_;
  std::vector<lattice::BrokenBond> broken_;
  EnergyHistory<lattice::EnergyBalance> energies_;
  double at_rest_; // energy_at_rest() [J/m]
  lattice::Snapshot last_valid_state_;
};

} // namespace latcon::output
