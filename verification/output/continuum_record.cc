#include "verification/output/continuum_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>

#include "support/full_precision.h"
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

void print_names(std::ostream &out, const std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> &reactions)
{
  for (const auto &[id, force] : reactions)
    out << "," << edge_name(id) << "_x," << edge_name(id) << "_y";
  out << "\n";
}

void print(std::ostream &out, const std::map<dealii::types::boundary_id, dealii::Tensor<1, 2>> &reactions)
{
  for (const auto &[id, force] : reactions)
    out << "," << support::full_precision(force[0]) << "," << support::full_precision(force[1]);
  out << "\n";
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
  if (!motion_.empty() && !(motion_.back().time < solver.time()))
    return;
  motion_.push_back({solver.time(), solver.ledger()});
  for (const continuum::BranchEnergy &branch : solver.branch_energies())
    branch_energies_.insert(branch_energies_.end(), {branch.stored, branch.dissipated});
}

void ContinuumRecord::check(const continuum::DynamicSolver &solver)
{
  const continuum::EnergyLedger &e = solver.ledger();
  ledger_.add({solver.time(), e.stored, e.kinetic, e.dissipated, 0., 0., e.work, e.imbalance});
}

double ContinuumRecord::last_time() const
{
  return motion_.empty() ? -std::numeric_limits<double>::infinity() : motion_.back().time;
}

void ContinuumRecord::check_loaded() const
{
  if (motion_.empty())
    throw std::invalid_argument("`motion` has no states");
  for (std::size_t row = 1; row < motion_.size(); ++row)
    if (!(motion_[row].time > motion_[row - 1].time))
      throw std::invalid_argument("times of `motion` do not increase");
  if (branch_energies_.size() != 2 * branches_.size() * motion_.size())
    throw std::invalid_argument("the number of `branch_energies` does not match `motion`");
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
               [this](std::ostream &out)
               {
                 out << "t,elastic,kinetic,micro_inertia,viscous,boundary_work,imbalance";
                 for (const std::string &branch : branches_)
                   out << "," << branch << "_stored," << branch << "_dissipated";
                 out << "\n";
                 auto of_branch = branch_energies_.begin();
                 for (const auto &[time, ledger] : motion_)
                 {
                   const char *separator = "";
                   for (const double value : {time, ledger.stored, ledger.kinetic, ledger.micro_kinetic,
                                              ledger.dissipated, ledger.work, ledger.imbalance})
                   {
                     out << separator << support::full_precision(value);
                     separator = ",";
                   }
                   for (std::size_t i = 0; i < 2 * branches_.size(); ++i)
                     out << "," << support::full_precision(*of_branch++);
                   out << "\n";
                 }
               });
    return;
  }
  write_file(directory + "/energy.csv",
             [this](std::ostream &out)
             {
               out << "load_factor,elastic\n";
               for (const Equilibrium &state : equilibria_)
                 out << support::full_precision(state.load_factor) << "," << support::full_precision(state.energy)
                     << "\n";
             });
  if (!equilibria_.empty())
    write_file(directory + "/reactions.csv",
               [this](std::ostream &out)
               {
                 out << "load_factor";
                 print_names(out, equilibria_.front().reactions);
                 for (const Equilibrium &state : equilibria_)
                 {
                   out << support::full_precision(state.load_factor);
                   print(out, state.reactions);
                 }
               });
  write_file(directory + "/newton.csv",
             [this](std::ostream &out)
             {
               out << "mesh,load_step,iteration,load_factor,residual,tolerance,energy,step_length,linear_iterations\n";
               for (const auto &[mesh, row] : iterations_)
                 out << mesh << "," << row.load_step << "," << row.iteration << ","
                     << support::full_precision(row.load_factor) << "," << support::full_precision(row.residual) << ","
                     << support::full_precision(row.tolerance) << "," << support::full_precision(row.energy) << ","
                     << support::full_precision(row.step_length) << "," << row.linear_iterations << "\n";
             });
  if (meshes_.size() > 1)
    write_file(directory + "/meshes.csv",
               [this](std::ostream &out)
               {
                 out << "cells,unknowns,elastic";
                 print_names(out, meshes_.front().reactions);
                 for (const MeshRow &row : meshes_)
                 {
                   out << row.n_cells << "," << row.n_unknowns << "," << support::full_precision(row.energy);
                   print(out, row.reactions);
                 }
               });
}

} // namespace latcon::output
