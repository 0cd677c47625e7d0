#pragma once

#include <filesystem>
#include <vector>

#include "lattice/simulation.h"
#include "verification/analysis/crack_measurement.h"

namespace latcon::output
{

/// What a fracture run leaves behind besides fields: the crack, the bonds that broke, the energies over time. All ranks
/// that share the sheet keep the same record.
class CrackRecord
{
public:
  explicit CrackRecord(lattice::Simulation &simulation);

  /// Notes the state before the first step. Collective.
  void start();

  /// Notes what a step has done. Collective. @param broken bonds that broke in it
  void step(const std::vector<lattice::BrokenBond> &broken);

  /// Notes the energies now. Collective. @throws SolverError as check() does
  void energies();

  /// Looks whether the sheet is still sound, and keeps it in mind as it is. Collective.
  /// @throws SolverError if its energies are not finite or more than there can be, saying when and where it comes
  /// apart; the simulation then shows the last sound state (see lattice::Simulation::show_snapshot)
  void check() { (void)sound_energies(); }

  /// Each site at which the tip was, and when.
  const std::vector<analysis::TipRecord> &tip() const { return tip_; }
  /// Reference X of the tip [m]; 0 without one.
  double tip_X() const { return tip_.empty() ? 0. : tip_.back().X; }
  /// Lagrangian speed over the last few spacings [m/s]; 0 while there is none.
  double speed() const { return speeds_.empty() ? 0. : speeds_.back(); }
  /// Largest |imbalance| of the recorded energies, over initial energy plus work of the edges [-]; not-a-number if one
  /// is not finite or none is recorded.
  double largest_imbalance() const;

  analysis::CrackMeasurement measure(double seed_tip_X) const;

  /// Writes crack.csv, broken_bonds.csv and energy.csv, on one rank. @throws OutputError
  void write_tables(const std::filesystem::path &directory) const;

  /// Writes crack.json. Collective; the first rank writes.
  /// @param seed_tip_X where the crack started [m]
  /// @param breaking_stretch lam_f of a bond that has not been toughened [-]
  /// @param skip_verification whether the material went unverified @throws OutputError
  void write_measurement(const std::filesystem::path &directory, const analysis::CrackMeasurement &measurement,
                         double seed_tip_X, double breaking_stretch, bool skip_verification);

  /// Saves or loads what was noted; see lattice::Simulation. The state now, which is loaded before, counts as sound:
  /// checkpoints are made of sound states alone. @throws std::invalid_argument for records that cannot be of this sheet
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("last_tip", last_tip_);
    archive.records("tip", tip_);
    archive("speeds", speeds_);
    archive("broken_at_tip", broken_at_tip_);
    archive.records("broken_bonds", broken_);
    archive.records("energies", energies_);
    if constexpr (Archive::loads)
      check_loaded();
    last_sound_ = {simulation_.state(), simulation_.band()};
  }

private:
  void check_loaded() const;
  void note_tip();
  lattice::EnergyBalance sound_energies();

  struct EnergyRow
  {
    double time;
    lattice::EnergyBalance balance;

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("time", time);
      archive("balance", balance);
    }
  };

  lattice::Simulation &simulation_;
  std::optional<std::size_t> last_tip_;
  std::vector<analysis::TipRecord> tip_;
  std::vector<double> speeds_;             // a value for each tip record [m/s]
  std::vector<std::size_t> broken_at_tip_; // bonds broken so far, likewise
  std::vector<lattice::BrokenBond> broken_;
  std::vector<EnergyRow> energies_;
  lattice::Snapshot last_sound_;
};

} // namespace latcon::output
