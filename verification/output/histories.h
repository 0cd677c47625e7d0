/// Histories that runs record: of the tip of a crack, of the energies of a motion.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "lattice/energy.h"
#include "lattice/material.h"
#include "support/require.h"
#include "verification/analysis/crack_records.h"
#include "verification/output/csv.h"
#include "verification/output/energy_ledger.h"

namespace latcon::output
{

/// Positions and speeds of the tip of a crack.
class TipHistory
{
public:
  /// @param spacing d of the lattice [m] @param length of the sheet [m]
  TipHistory(double spacing, double length) : spacing_(spacing), length_(length) {}

  void add(const analysis::TipRecord &tip) { records_.push_back(tip); }
  const std::vector<analysis::TipRecord> &records() const { return records_; }
  /// Returns reference X of the tip [m]; 0 without a tip.
  double X() const { return records_.empty() ? 0. : records_.back().X; }
  /// Returns the Lagrangian speed over the last few spacings [m/s]; 0 if it is not yet known.
  double speed() const { return speed_after(records_.size()); }

  /// Returns crack.csv.
  std::string csv() const;

  /// Saves or loads the history. @param now time of the motion, which must be loaded first [s]
  /// @throws std::invalid_argument for positions of later times, or outside the sheet
  template <class Archive>
  void archive(Archive &archive, double now)
  {
    archive.records("tip", records_);
    if constexpr (Archive::loads)
      check_loaded(now);
  }

private:
  double speed_after(std::size_t n) const; // speed() after the first n records
  void check_loaded(double now) const;

  double spacing_, length_;
  std::vector<analysis::TipRecord> records_;
};

/// Requires that the times of the elements of a loaded history increase up to the current time.
/// @throws std::invalid_argument
template <class History, class TimeOf>
void require_increasing_times(const History &history, double now, const std::string &name, const TimeOf &time_of)
{
  double before = 0.;
  for (const auto &element : history)
  {
    support::require(time_of(element) >= before && time_of(element) <= now,
                     "times of `" + name + "` do not increase up to the current time");
    before = time_of(element);
  }
}

/// Returns the names of the mechanisms of memories in the columns of energy.csv, in the order of
/// lattice::Simulation::mechanism_energies() and of bridge::homogenised_memory(): "nearest_branch_1", ...
inline std::vector<std::string> mechanism_names(const lattice::Material &material)
{
  std::vector<std::string> names;
  const auto add = [&](const std::string &shell, const lattice::Shell &bonds)
  {
    if (std::holds_alternative<lattice::PlasticMemory>(bonds.memory))
      names.push_back(shell + "_plastic");
    else
      for (std::size_t m = 1; m <= lattice::properties(bonds.memory).n_mechanisms; ++m)
        names.push_back(shell + "_branch_" + std::to_string(m));
  };
  add("nearest", material.nearest);
  if (material.next_nearest)
    add("next_nearest", *material.next_nearest);
  if (material.third_nearest)
    add("third_nearest", *material.third_nearest);
  return names;
}

/// Energies of a motion over time, and those of its mechanisms with memory.
template <class Energies>
class EnergyHistory
{
public:
  /// @param mechanisms their names, as mechanism_names() returns
  explicit EnergyHistory(std::vector<std::string> mechanisms = {}) : mechanisms_(std::move(mechanisms)) {}

  /// Adds energies, unless there are some of this time [s].
  template <class MechanismEnergies = std::vector<lattice::MechanismEnergy>>
  void add(double time, const Energies &energies, const MechanismEnergies &of_mechanisms = {})
  {
    if (!(time > last_time()))
      return;
    rows_.push_back({time, energies});
    for (const auto &mechanism : of_mechanisms)
      of_mechanisms_.insert(of_mechanisms_.end(), {mechanism.stored, mechanism.dissipated});
  }

  /// Returns the time of the last energies [s]; minus infinity before the first.
  double last_time() const { return rows_.empty() ? -std::numeric_limits<double>::infinity() : rows_.back().time; }
  bool empty() const { return rows_.empty(); }

  /// Returns LedgerCheck::imbalance() [-]. @param at_rest [J/m] @param state_of LedgerState of a time and its energies
  template <class StateOf>
  double imbalance(double at_rest, const StateOf &state_of) const
  {
    LedgerCheck check;
    for (const auto &[time, energies] : rows_)
      check.add(state_of(time, energies));
    return check.imbalance(at_rest);
  }

  /// Returns energy.csv. @param names of the columns between time and mechanisms @param values_of numbers in them
  template <class ValuesOf>
  std::string csv(std::vector<std::string> names, const ValuesOf &values_of) const
  {
    names.insert(names.begin(), "t");
    for (const std::string &mechanism : mechanisms_)
      names.insert(names.end(), {mechanism + "_stored", mechanism + "_dissipated"});
    Table table(std::move(names));
    auto of_mechanism = of_mechanisms_.begin();
    for (const auto &[time, energies] : rows_)
    {
      std::vector<Table::Cell> row{time};
      for (const double value : values_of(energies))
        row.emplace_back(value);
      for (std::size_t i = 0; i < 2 * mechanisms_.size(); ++i)
        row.emplace_back(*of_mechanism++);
      table.add(std::move(row));
    }
    return table.csv();
  }

  /// Saves or loads the history. @param now time of the motion, which must be loaded first [s]
  /// @throws std::invalid_argument unless there are energies at increasing times, with those of all mechanisms
  template <class Archive>
  void archive(Archive &archive, double now)
  {
    archive.records("energies", rows_);
    if (!mechanisms_.empty())
      archive("mechanism_energies", of_mechanisms_);
    if constexpr (Archive::loads)
    {
      support::require(!rows_.empty(), "`energies` is empty");
      require_increasing_times(rows_, now, "energies", [](const Row &row) { return row.time; });
      support::require(of_mechanisms_.size() == 2 * mechanisms_.size() * rows_.size(),
                       "the number of `mechanism_energies` does not match `energies`");
    }
  }

private:
  struct Row
  {
    double time;
    Energies energies;

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("time", time);
      archive("energies", energies);
    }
  };

  std::vector<Row> rows_;
  std::vector<std::string> mechanisms_;
  std::vector<double> of_mechanisms_; // stored and dissipated, per mechanism and row [J/m]
};

} // namespace latcon::output
