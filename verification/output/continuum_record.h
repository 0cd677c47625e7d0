#pragma once

#include <string>
#include <utility>
#include <vector>

#include "continuum/dynamic_solver.h"
#include "continuum/static_solver.h"
#include "verification/output/csv.h"
#include "verification/output/histories.h"

namespace latcon::output
{

/// Tables of a run of the finite element sheet. All ranks record, one rank writes.
class ContinuumRecord
{
public:
  /// @param branches names of the Maxwell branches of a motion in the columns of energy.csv, as mechanism_names() gives
  explicit ContinuumRecord(std::vector<std::string> branches = {}) : motion_(std::move(branches)) {}

  /// Records load factor, energy and reactions of an equilibrium. Replaces that of the same load factor on a coarser
  /// mesh.
  void equilibrium(const continuum::StaticSolver &solver);

  /// Records a mesh of an adaptive series, after equilibrium was found on it.
  void mesh(const continuum::StaticSolver &solver);

  /// Records the Newton iterations of a solve, on the mesh that is recorded next.
  void newton(const continuum::SolverReport &report);

  /// Records a state of a motion, unless it was recorded already.
  void motion(const continuum::DynamicSolver &solver);

  /// Checks the energy ledger of a motion at its start or after a step.
  void check(const continuum::DynamicSolver &solver);
  const LedgerCheck &ledger() const { return ledger_; }

  /// Returns the largest |reaction of an edge| on the last recorded mesh [N/m]; 0 without a mesh.
  double largest_reaction() const;
  /// Returns its relative change from the previous mesh [-]; infinity without one.
  double reaction_change() const;

  /// Returns the time of the last recorded state of a motion [s]; minus infinity before the first.
  double last_time() const { return motion_.last_time(); }

  /// Saves or loads the recorded states of a motion. @throws std::invalid_argument as EnergyHistory::archive()
  template <class Archive>
  void archive(Archive &archive)
  {
    motion_.archive(archive, std::numeric_limits<double>::infinity());
    archive("ledger", ledger_);
  }

  /// Writes energy.csv and, for equilibria, reactions.csv, newton.csv and, with two meshes or more, meshes.csv.
  /// @throws OutputError
  void write(const std::string &directory) const;

private:
  struct Equilibrium
  {
    std::vector<Table::Cell> numbers;
    std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> reactions;
  };
  static double largest_reaction_of(const Equilibrium &state);
  static void write_reactions(const std::string &path, std::vector<std::string> columns,
                              const std::vector<Equilibrium> &rows);

  std::vector<Equilibrium> equilibria_; // load factor, energy
  std::vector<Equilibrium> meshes_;     // cells, unknowns, energy
  Table iterations_{{"mesh", "load_step", "iteration", "load_factor", "residual", "tolerance", "energy", "step_length",
                     "linear_iterations"}}; // with the index of the mesh, from 0
  EnergyHistory<continuum::EnergyLedger> motion_;
  LedgerCheck ledger_; // of every step
};

/// Returns the name of an edge: "left", "right", "bottom", "top", "inner", or its number.
std::string edge_name(dealii::types::boundary_id id);

} // namespace latcon::output
