#include "verification/output/continuum_record.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/largest_error.h"
#include "verification/output/output_file.h"

namespace latcon::output
{

std::string edge_name(dealii::types::boundary_id id)
{
  const char *const names[] = {"left", "right", "bottom", "top", "inner"};
  return id < 5 ? names[id] : std::to_string(id);
}

void ContinuumRecord::equilibrium(const continuum::StaticSolver &solver)
{
  if (!equilibria_.empty() && equilibria_.back().numbers[0] == Table::Cell(solver.load_factor()))
    equilibria_.pop_back();
  equilibria_.push_back({{solver.load_factor(), solver.total_energy()}, solver.reactions()});
}

void ContinuumRecord::mesh(const continuum::StaticSolver &solver)
{
  meshes_.push_back({{std::uint64_t{solver.sheet().mesh().n_global_active_cells()},
                      std::uint64_t{solver.sheet().dof_handler().n_dofs()}, solver.total_energy()},
                     solver.reactions()});
}

void ContinuumRecord::newton(const continuum::SolverReport &report)
{
  for (const continuum::NewtonIteration &row : report.iterations)
    iterations_.add({meshes_.size(), std::uint64_t{row.load_step}, std::uint64_t{row.iteration}, row.load_factor,
                     row.residual, row.tolerance, row.energy, row.step_length, std::uint64_t{row.linear_iterations}});
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

double ContinuumRecord::largest_reaction_of(const Equilibrium &state)
{
  support::Extremes sizes;
  sizes.add(0.);
  for (const auto &[id, force] : state.reactions)
    sizes.add(force.norm());
  return sizes.largest();
}

double ContinuumRecord::largest_reaction() const
{
  return meshes_.empty() ? 0. : largest_reaction_of(meshes_.back());
}

double ContinuumRecord::reaction_change() const
{
  if (meshes_.size() < 2)
    return std::numeric_limits<double>::infinity();
  return std::abs(largest_reaction() - largest_reaction_of(meshes_[meshes_.size() - 2])) / largest_reaction();
}

// Writes the first numbers of rows, each followed by the reactions of all edges. @param columns of the numbers
void ContinuumRecord::write_reactions(const std::string &path, std::vector<std::string> columns,
                                      const std::vector<Equilibrium> &rows)
{
  const auto n_numbers = static_cast<std::ptrdiff_t>(columns.size());
  for (const auto &[id, force] : rows.front().reactions)
    columns.insert(columns.end(), {edge_name(id) + "_x", edge_name(id) + "_y"});
  Table table(std::move(columns));
  for (const Equilibrium &row : rows)
  {
    std::vector<Table::Cell> cells(row.numbers.begin(), row.numbers.begin() + n_numbers);
    for (const auto &[id, force] : row.reactions)
      cells.insert(cells.end(), {force[0], force[1]});
    table.add(std::move(cells));
  }
  write_file(path, table.csv());
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
    energy.add(state.numbers);
  write_file(directory + "/energy.csv", energy.csv());
  if (!equilibria_.empty())
    write_reactions(directory + "/reactions.csv", {"load_factor"}, equilibria_);
  write_file(directory + "/newton.csv", iterations_.csv());
  if (meshes_.size() > 1)
    write_reactions(directory + "/meshes.csv", {"cells", "unknowns", "elastic"}, meshes_);
}

} // namespace latcon::output
