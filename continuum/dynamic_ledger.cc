// Energy balance and momentum of DynamicSolver.
#include "continuum/dynamic_step.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

using namespace dealii;

namespace latcon::continuum
{
void DynamicSolver::update_energies(EnergyLedger &ledger, const Vector &u, const Vector &v, const double load_factor,
                                    const std::vector<BranchEnergy> &branches) const
{
  ledger.stored = sheet_.energy(with_ghosts(u), load_factor);
  for (const BranchEnergy &branch : branches)
    ledger.stored += branch.stored;
  Vector momenta = sheet_.make_owned();
  multiply_by_mass(full_mass_, v, momenta);
  ledger.kinetic = 0.5 * (momenta * v);
  ledger.micro_kinetic = 0.;
  if (inertia_.length > 0.)
  {
    multiply_by_mass(plain_mass_, v, momenta);
    ledger.micro_kinetic = ledger.kinetic - 0.5 * (momenta * v);
  }
}

// Returns the ledger at the end of a step with displacement u, velocity v and energies of branches.
EnergyLedger DynamicSolver::ledger_after(const Step &step, const Vector &u, const Vector &v,
                                         const std::vector<BranchEnergy> &branches) const
{
  EnergyLedger ledger = ledger_;
  update_energies(ledger, u, v, step.last_load_factor, branches);

  Vector rise = u;
  rise -= step.u;
  const Vector middle = with_ghosts(Step::mean(0.5, step.u, u));
  Vector rate = rise;
  rate *= 1. / step.dt;
  const Vector middle_velocity = with_ghosts(rate);
  const GradientLoad load = {0.5 * (step.first_load_factor + step.last_load_factor), step.load_rate()};
  const double factor = load.factor;
  const double dissipated = step.dt * rate_forces_.dissipation(middle, middle_velocity, load);
  double on_branches = 0.; // work
  ledger.dissipated += dissipated;
  for (std::size_t i = 0; i < branches.size(); ++i)
  {
    const double of_branch = branches[i].dissipated - branch_energies_[i].dissipated;
    ledger.dissipated += of_branch;
    on_branches += of_branch + branches[i].stored - branch_energies_[i].stored;
  }

  const double released = -0.5 * (step.first_release_share + step.last_release_share) * (release_forces_ * rise);
  ledger.released += released;
  ledger.work += factor * (loads_ * rise) - released;
  if (step.first_load_factor != step.last_load_factor)
  {
    Vector forces = sheet_.make_owned();
    rate_forces_.add_forces(0.5 * step.dt, middle, middle_velocity, load, forces, nullptr);
    if (!sheet_.conditions().normal_gradients.empty())
    {
      ledger.work += sheet_.energy(middle, step.last_load_factor) - sheet_.energy(middle, step.first_load_factor);
      // Prescribed normal gradients do what the nodal forces of gradient parts leave.
      if (rate_forces_.has_gradient())
        ledger.work += dissipated + on_branches - forces * rise;
    }
    if (!sheet_.conditions().displacements.empty())
    {
      // Reactions at the middle of the step; the accelerations of the time integrator are not of second order there.
      Vector inertial = sheet_.make_owned();
      Vector magnitude = sheet_.make_owned();
      Vector elastic = sheet_.make_owned();
      sheet_.residual(middle, elastic, magnitude, factor);
      forces += elastic;
      Vector change = v;
      change -= step.v;
      change *= 1. / step.dt;
      multiply_by_mass(full_mass_, change, inertial);
      double own = 0.;
      for (const types::global_dof_index i : sheet_.owned())
        if (homogeneous_.is_constrained(i) && !sheet_.conformity_constraints().is_constrained(i))
          own += (forces(i) + inertial(i) - factor * loads_(i)) * rise(i);
      ledger.work += dealii::Utilities::MPI::sum(own, sheet_.communicator());
    }
  }
  ledger.imbalance = ledger.stored + ledger.kinetic + ledger.dissipated - ledger.work - initial_energy_;
  return ledger;
}

Tensor<1, 2> DynamicSolver::momentum() const
{
  Vector v = sheet_.make_owned();
  v = velocity_;
  Vector momenta = sheet_.make_owned();
  multiply_by_mass(full_mass_, v, momenta);
  Tensor<1, 2> sum;
  for (unsigned int i = 0; i < 2; ++i)
  {
    ComponentMask mask(2, false);
    mask.set(i, true);
    for (const types::global_dof_index dof : DoFTools::extract_dofs(sheet_.dof_handler(), mask))
      if (sheet_.owned().is_element(dof))
        sum[i] += momenta(dof);
  }
  return dealii::Utilities::MPI::sum(sum, sheet_.communicator());
}
} // namespace latcon::continuum
