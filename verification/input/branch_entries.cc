#include "support/full_precision.h"
#include "verification/input/case.h"

namespace latcon::input
{

void ShellCase::declare_branches(Parameters &parameters, const std::string &section)
{
  parameters.add(section, "branch moduli", branch_moduli, Magnitude{}, "Pa",
                 "moduli E_i of Maxwell branches parallel to the bond law, at most " +
                   std::to_string(lattice::max_history_variables) + "; empty: no branches");
  parameters.add(section, "relaxation times", relaxation_times, Magnitude{}, "s",
                 "relaxation times tau_i of the Maxwell branches, in the order of their moduli");
}

void ShellCase::check_branches(Parameters &parameters, const std::string &section) const
{
  const std::string moduli = section + "/branch moduli", times = section + "/relaxation times";
  if (branch_moduli.size() != relaxation_times.size())
    parameters.error(times,
                     "each branch has a modulus and a relaxation time; there are " +
                       std::to_string(branch_moduli.size()) + " moduli and " + std::to_string(relaxation_times.size()) +
                       " times",
                     {moduli});
  else if (branch_moduli.size() > lattice::max_history_variables)
    parameters.error(moduli,
                     "a bond has at most " + std::to_string(lattice::max_history_variables) + " branches, not " +
                       std::to_string(branch_moduli.size()),
                     {times});
}

void ShellCase::check_relaxation_times(Parameters &parameters, const std::string &section, const double step) const
{
  for (std::size_t i = 0; i < relaxation_times.size(); ++i)
    if (relaxation_times[i] < step)
    {
      parameters.error(section + "/relaxation times",
                       "a branch with " + support::full_precision(relaxation_times[i]) +
                         " s relaxes within one time step, " + support::full_precision(step) +
                         " s, and acts as a dashpot; omit it and add its modulus times its relaxation time, " +
                         support::full_precision(branch_moduli[i] * relaxation_times[i]) +
                         " Pa s, to the viscosity, or give a smaller Time/step",
                       {section + "/branch moduli", section + "/viscosity", "Time/step", "Time/integrator",
                        "Time/stages", "Time/safety factor", "Sheet/spacing"});
      return;
    }
}

lattice::BondMemory ShellCase::memory() const
{
  if (branch_moduli.empty() || branch_moduli.size() != relaxation_times.size() ||
      branch_moduli.size() > lattice::max_history_variables)
    return lattice::NoMemory();
  std::vector<lattice::MaxwellMemory::Branch> branches;
  for (std::size_t i = 0; i < branch_moduli.size(); ++i)
    branches.push_back({branch_moduli[i], relaxation_times[i]});
  return lattice::MaxwellMemory(std::move(branches));
}

} // namespace latcon::input
