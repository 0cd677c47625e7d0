#include <algorithm>
#include <string>

#include "verification/input/case.h"

namespace latcon::input
{

enum class BreakingCase::Rule : int
{
  critical_stretch,
  rate_stretch,
  bond_energy
};

bool BreakingCase::needs_energy() const
{
  return rule == Rule::bond_energy;
}

void BreakingCase::declare(Parameters &p)
{
  p.add(
    "Fracture", "rule", rule,
    {{"critical-stretch", Rule::critical_stretch},
     {"rate-stretch", Rule::rate_stretch},
     {"bond-energy", Rule::bond_energy}},
    "what breaks a bond: a stretch beyond lam_f; beyond lam_f (1 + (k - 1) r tau / (1 + r tau)) with the rate r of "
    "the stretch; or more energy in its spring, per reference volume, than a nearest-neighbour bond stores at lam_f");
  p.add("Fracture", "shell factors", shell_factors, Range{0.01, 100.}, "1",
        "critical-stretch: lam_f of the nearest, next-nearest and third-nearest neighbours over `breaking stretch`; "
        "empty: 1")
    .read_by = ReadBy::claims_on_user_laws;
  p.add("Fracture", "rate factor", rate_factor, Range{1., 100.}, "1", "rate-stretch: k, factor of lam_f at high rates")
    .read_by = ReadBy::claims_on_user_laws;
  p.add("Fracture", "rate time", rate_time, magnitude, "s",
        "rate-stretch: tau; at the rate 1 / tau half of the increase is reached");
}

void BreakingCase::check(const Case &input, Parameters &p) const
{
  const bool has_third = input.has_shell(2), has_second = input.has_shell(1);
  const std::size_t n = has_third ? 3 : has_second ? 2 : 1;
  if (!shell_factors.empty() && shell_factors.size() != n)
    p.error("Fracture/shell factors",
            "the sheet has bonds up to shell " + std::to_string(n) + ": give as many factors, not " +
              std::to_string(shell_factors.size()),
            {"Next-nearest neighbours/present", "Third-nearest neighbours/present"});
  if (!shell_factors.empty() && rule != Rule::critical_stretch)
    p.error("Fracture/shell factors", "only critical-stretch has a limit for each shell; omit them", {"Fracture/rule"});
  if ((rate_factor != 1.) != (rule == Rule::rate_stretch))
    p.error("Fracture/rate factor",
            rate_factor == 1. ? "rate-stretch with a factor of 1 is critical-stretch; give a larger one"
                              : "only rate-stretch has a rate factor; omit it",
            {"Fracture/rule"});
  for (std::size_t shell = 0; shell < lattice::n_shells; ++shell)
    if (needs_energy() && input.has_shell(shell) && input.shell(shell).has_user_law())
      p.error("Fracture/rule",
              "bond-energy needs the energy of bonds at any stretch, which user-defined laws do not have; give "
              "critical-stretch",
              {std::string(Case::shell_sections[shell]) + "/law"});
}

double BreakingCase::largest_factor() const
{
  double largest = rate_factor;
  for (const double factor : shell_factors)
    largest = std::max(largest, factor);
  return largest;
}

std::shared_ptr<const lattice::BreakingRule> BreakingCase::make(const Case &input) const
{
  const double stretch = *input.breaking_stretch;
  if (rule == Rule::bond_energy)
  {
    const lattice::Material material = input.material();
    return std::make_shared<lattice::BondEnergy>(material, lattice::energy(material.nearest.law, stretch));
  }
  std::array<double, lattice::n_shells> of_shells{};
  // Shells that the sheet lacks do not lower the smallest limit.
  for (std::size_t shell = 0; shell < lattice::n_shells; ++shell)
    of_shells[shell] = !input.has_shell(shell)        ? of_shells[0]
                       : shell < shell_factors.size() ? stretch * shell_factors[shell]
                                                      : stretch;
  return std::make_shared<lattice::CriticalStretch>(of_shells, rate_factor, rate_time);
}

} // namespace latcon::input
