#include "verification/output/continuum_record.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/largest_error.h"
#include "verification/output/output_file.h"

namespace latcon::output
{
namespace
{

double largest(const std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> &reactions)
{
  support::Extremes sizes;
  sizes.add(0.);
  for (const auto &[id, force] : reactions)
    sizes.add(force.norm());
  return sizes.largest();
}

// Writes rows of numbers, each followed by the reactions of all edges. @param numbers_of row
template <class Rows, class NumbersOf>
void write_reactions(const std::string &path, std::vector<std::string> columns, const Rows &rows,
                     const NumbersOf &numbers_of)
{
  for (const auto &[id, force] : rows.front().reactions)
    columns.insert(columns.end(), {edge_name(id) + "_x", edge_name(id) + "_y"});
  Table table(std::move(columns));
  for (const auto &row : rows)
  {
    std::vector<Table::Cell> cells = numbers_of(row);
    for (const auto &[id, force] : row.reactions)
      cells.insert(cells.end(), {force[0], force[1]});
    table.add(std::move(cells));
  }
  write_file(path, table.csv());
}

} // namespace

std::string edge_name(dealii::types::boundary_id id)
{
  const char *const names[] = {"left", "right", "bottom", "top", "inner"};
  return id < 5 ? names[id] : std::to_string(id);
}

void ContinuumRecord::equilibrium(const continuum::StaticSolver &solver)
{
  if (!equilibria_.empty() && equilibria_.back().load_factor == solver.load_factor())
    equilibria_.pop_back();
  equilibria_.push_back({solver.load_factor(), solver.total_energy(), solver.reactions()});
}

void ContinuumRecord::mesh(const continuum::StaticSolver &solver)
{
  meshes_.push_back({solver.sheet().mesh().n_global_active_cells(), solver.sheet().dof_handler().n_dofs(),
                     solver.total_energy(), solver.reactions()});
}

void ContinuumRecord::newton(const continuum::SolverReport &report)
{
  for (const continuum::NewtonIteration &iteration : report.iterations)
    iterations_.emplace_back(meshes_.size(), iteration);
}

void ContinuumRecord::motion(const continuum::DynamicSolver &solver)
{
  motion_.add(solver.time(), solver.ledger(), solver.branch_energies());
}

void ContinuumRecord::check(const continuum::DynamicSolver &solver)
{
  const continuum::EnergyLedger &e = solver.ledger();
  ledger_.add({solver.time(), e.stored, e.kinetic, e.dissipated, 0., e.work, e.imbalance});
}

double ContinuumRecord::largest_reaction() const
{
  return meshes_.empty() ? 0. : largest(meshes_.back().reactions);
}

double ContinuumRecord::reaction_change() const
{
  if (meshes_.size() < 2)
    return std::numeric_limits<double>::infinity();
  const double before = largest(meshes_[meshes_.size() - 2].reactions);
  return std::abs(largest_reaction() - before) / largest_reaction();
}

void ContinuumRecord::write(const std::string &directory) const
{
  if (!motion_.empty())
  {
    write_file(directory + "/energy.csv",
               motion_.csv({"elastic", "kinetic", "micro_inertia", "viscous", "boundary_work", "imbalance"},
                           [](const continuum::EnergyLedger &e) {
                             return std::array{e.stored,     e.kinetic, e.micro_kinetic,
                                               e.dissipated, e.work,    e.imbalance};
                           }));
    return;
  }
  Table energy({"load_factor", "elastic"});
  for (const Equilibrium &state : equilibria_)
    energy.add({state.load_factor, state.energy});
  write_file(directory + "/energy.csv", energy.csv());
  if (!equilibria_.empty())
    write_reactions(directory + "/reactions.csv", {"load_factor"}, equilibria_,
                    [](const Equilibrium &state) { return std::vector<Table::Cell>{state.load_factor}; });
  Table newton({"mesh", "load_step", "iteration", "load_factor", "residual", "tolerance", "energy", "step_length",
                "linear_iterations"});
  for (const auto &[mesh, row] : iterations_)
    newton.add({mesh, std::uint64_t{row.load_step}, std::uint64_t{row.iteration}, row.load_factor, row.residual,
                row.tolerance, row.energy, row.step_length, std::uint64_t{row.linear_iterations}});
  write_file(directory + "/newton.csv", newton.csv());
  if (meshes_.size() > 1)
    write_reactions(directory + "/meshes.csv", {"cells", "unknowns", "elastic"}, meshes_,
                    [](const MeshRow &mesh) {
                      return std::vector<Table::Cell>{std::uint64_t{mesh.n_cells}, std::uint64_t{mesh.n_unknowns},
                                                      mesh.energy};
                    });
}

} // namespace latcon::output
