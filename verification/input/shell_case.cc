#include "support/full_precision.h"
#include "verification/input/case.h"

namespace latcon::input
{

void ShellCase::declare(Parameters &parameters, const std::string &section)
{
  parameters
    .add(section, "law", law,
         {{"mooney-rivlin", Law::mooney_rivlin},
          {"linear", Law::linear},
          {"expression", Law::expression},
          {"library", Law::library}},
         "bond law: rod of incompressible Mooney-Rivlin rubber with constants a and b, linear spring, or your "
         "own by an expression or a shared library")
    .read_by = ReadBy::claims;
  parameters.add(section, "a", a, magnitude_or_zero, "Pa", "a = 2 C1 of a Mooney-Rivlin bond").read_by = ReadBy::claims;
  parameters.add(section, "b", b, magnitude_or_zero, "Pa", "b = 2 C2 of a Mooney-Rivlin bond").read_by = ReadBy::claims;
  parameters.add(section, "modulus", modulus, magnitude, "Pa", "modulus e of a linear bond").read_by = ReadBy::claims;
  parameters
    .add(section, "area factor", area_factor, magnitude, "1",
         "s: cross-section of a bond over (sqrt3 / 2) d h, with the thickness h")
    .read_by = ReadBy::claims;
  parameters.add(section, "viscosity", viscosity, magnitude_or_zero, "Pa s", "eta of the Kelvin dashpot along the bond")
    .read_by = ReadBy::claims;
  declare_memory(parameters, section);
  user_law.declare(parameters, section);
}

void ShellCase::check(Parameters &parameters, const std::string &section, const double longest)
{
  if (has_user_law())
    user_law.check(parameters, section, law == Law::library, constants(), longest);
  else if (!has_stiffness())
    parameters.error(section + "/a", "a bond needs stiffness: a + b must be positive", {section + "/b"});
  for (const auto &[entry, value] : {std::pair("psi", user_law.psi), std::pair("parameters", user_law.parameters),
                                     std::pair("library", user_law.library)})
    if (!has_user_law() && !value.empty())
      parameters.error(section + "/" + entry, "the law does not read it; omit it, or give it empty",
                       {section + "/law"});
  check_memory(parameters, section);
}

lattice::Shell ShellCase::shell(const double longest) const
{
  if (has_user_law())
    return {lattice::CustomBond(user_law.law(law == Law::library, constants(), longest)), area_factor, viscosity,
            memory()};
  if (law == Law::linear)
    return {lattice::LinearBond{modulus}, area_factor, viscosity, memory()};
  return {lattice::MooneyRivlinBond{a, b}, area_factor, viscosity, memory()};
}

void ShellCase::declare_memory(Parameters &parameters, const std::string &section)
{
  parameters
    .add(section, "branch moduli", branch_moduli, magnitude, "Pa",
         "moduli E_i of Maxwell branches parallel to the bond law, at most " +
           std::to_string(lattice::max_history_variables) + "; empty: no branches")
    .read_by = ReadBy::claims;
  parameters
    .add(section, "relaxation times", relaxation_times, magnitude, "s",
         "relaxation times tau_i of the Maxwell branches, in the order of their moduli")
    .read_by = ReadBy::claims;
  parameters.add(
    section, "plastic modulus", plastic_modulus, magnitude_or_zero, "Pa",
    "modulus E of a spring in series with a friction slider, parallel to the bond law; 0: no plastic stretch");
  parameters.add(section, "yield stress", yield_stress, magnitude_or_zero, "Pa",
                 "stress Y of the spring beyond which the slider moves; more than 0 with a plastic modulus");
  parameters.add(section, "hardening modulus", hardening, magnitude_or_zero, "Pa",
                 "K: growth of the yield stress with the accumulated plastic stretch");
}

void ShellCase::check_memory(Parameters &parameters, const std::string &section) const
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
  if (plastic_modulus > 0. && !branch_moduli.empty())
    parameters.error(section + "/plastic modulus", "bonds have Maxwell branches or plastic stretch, not both; give 0",
                     {moduli});
  if (plastic_modulus > 0. ? yield_stress == 0. : yield_stress > 0. || hardening > 0.)
    parameters.error(
      section + (plastic_modulus > 0. ? "/yield stress" : "/plastic modulus"),
      "plastic stretch needs both a modulus and a yield stress > 0",
      {section + (plastic_modulus > 0. ? "/plastic modulus" : "/yield stress"), section + "/hardening modulus"});
}

void ShellCase::check_relaxation_times(Parameters &parameters, const std::string &section, const double step,
                                       std::vector<std::string> step_entries) const
{
  for (std::size_t i = 0; i < relaxation_times.size(); ++i)
    if (relaxation_times[i] < step)
    {
      const std::string longest = step_entries.front();
      step_entries.insert(step_entries.end(), {section + "/branch moduli", section + "/viscosity"});
      parameters.error(section + "/relaxation times",
                       "a branch with " + support::full_precision(relaxation_times[i]) +
                         " s relaxes within one time step, " + support::full_precision(step) +
                         " s, and acts as a dashpot; omit it and add its modulus times its relaxation time, " +
                         support::full_precision(branch_moduli[i] * relaxation_times[i]) +
                         " Pa s, to the viscosity, or give a smaller " + longest,
                       step_entries);
      return;
    }
}

lattice::BondMemory ShellCase::memory() const
{
  if (plastic_modulus > 0. && yield_stress > 0.)
    return lattice::PlasticMemory(plastic_modulus, yield_stress, hardening);
  if (branch_moduli.empty() || branch_moduli.size() != relaxation_times.size() ||
      branch_moduli.size() > lattice::max_history_variables)
    return {};
  std::vector<lattice::MaxwellMemory::Branch> branches;
  for (std::size_t i = 0; i < branch_moduli.size(); ++i)
    branches.push_back({branch_moduli[i], relaxation_times[i]});
  return lattice::MaxwellMemory(std::move(branches));
}

void require_no_plasticity(const Case &input, Parameters &parameters, const std::string &reason)
{
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (input.has_shell(number) && input.shell(number).plastic_modulus > 0.)
      parameters.error(std::string(Case::shell_sections[number]) + "/plastic modulus", reason + "; give 0");
}

} // namespace latcon::input
