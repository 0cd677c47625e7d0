#pragma once

#include <string>
#include <vector>

#include "continuum/dynamic_solver.h"
#include "continuum/static_solver.h"

namespace latcon::output
{

/// The tables that a run of the finite element sheet leaves behind besides fields. All ranks note, one writes.
class ContinuumRecord
{
public:
  /// An equilibrium: the load factor, energy and reactions of it. It takes the place of one at the same load factor on
  /// a coarser mesh.
  void equilibrium(const continuum::StaticSolver &solver);

  /// A mesh of an adaptive series, once equilibrium is found on it.
  void mesh(const continuum::StaticSolver &solver);

  /// The Newton iterations of a solve, on the mesh that is to be noted next.
  void newton(const continuum::SolverReport &report);

  /// A state of a motion, unless it is the one noted last.
  void motion(const continuum::DynamicSolver &solver);

  /// Largest of |reaction of an edge| of the last mesh noted [N/m], and its relative change from the one before [-]; 0
  /// and infinite where there is none.
  double largest_reaction() const;
  double reaction_change() const;

  /// Time of the state of a motion noted last [s]; minus infinity before the first.
  double last_time() const;

  /// Stores the states of a motion that were noted, or takes them from there. @throws std::invalid_argument if there
  /// are none, or their times do not grow
  template <class Archive>
  void archive(Archive &archive)
  {
    archive.records("motion", motion_);
    if constexpr (Archive::loads)
      check_loaded();
  }

  /// Writes energy.csv and, for equilibria, reactions.csv, newton.csv and, with two meshes or more, meshes.csv.
  /// @throws OutputError
  void write(const std::string &directory) const;

private:
  void check_loaded() const;
  using Reactions = std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>>;

  struct Equilibrium
  {
    double load_factor;
    double energy;
    Reactions reactions;
  };
  struct MeshRow
  {
    dealii::types::global_cell_index n_cells;
    dealii::types::global_dof_index n_unknowns;
    double energy;
    Reactions reactions;
  };
  struct MotionRow
  {
    double time;
    continuum::EnergyLedger ledger;

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("time", time);
      archive("ledger", ledger);
    }
  };

  std::vector<Equilibrium> equilibria_;
  std::vector<MeshRow> meshes_;
  std::vector<std::pair<std::size_t, continuum::NewtonIteration>> iterations_; // with the number of the mesh, from 0
  std::vector<MotionRow> motion_;
};

/// "left", "right", "bottom", "top", "inner", or the number of another edge.
std::string edge_name(dealii::types::boundary_id id);

} // namespace latcon::output
