#include "lattice/time_step.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "lattice/chebyshev_stages.h"
#include "support/dense.h"

namespace latcon::lattice
{
namespace
{

struct Rates
{
  double omega_square = 0.;                                     // [1/s^2]
  double gamma = 0.;                                            // [1/s]
  double damped_step = std::numeric_limits<double>::infinity(); // 1 / kappa [s]
};

// Share for Runge-Kutta-Chebyshev, with which the crack of Fig. 1 still runs as with steps twenty times shorter
// (theory.md, section "Long steps").
constexpr double share_of_elastic_limit = 0.35;

// Share for velocity Verlet, with which the ledger of a crack in a weakly damped sheet closes to 1e-4.
constexpr double share_for_recoil = 0.1;

TimeStepLimits limits(double omega_square, double gamma)
{
  return {2. / std::sqrt(omega_square), 1. / gamma, 2. / (gamma + std::sqrt(gamma * gamma + omega_square))};
}

// The smallest stretch of the bonds of each shell.
using SmallestStretch = Eigen::Array<double, n_shells, 1>;

// Bonds whose smallest stretch is given for each shell. All bonds of a site may be as stiff as the stiffest.
Rates bound_of_bonds(const TriangularLattice &lattice, const Material &material,
                     const SmallestStretch &smallest_stretch)
{
  const double mass = site_mass(material, lattice), stiffest = material.disorder.stiffness.largest();
  Rates rates;
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (const Shell *shell = material.shell(lattice, kind))
    {
      // In motions that leave memories no time to relax [Pa].
      const double stiffness = largest_stiffness(shell->law, smallest_stretch[lattice.shell(kind)]) +
                               properties(shell->memory).largest_stiffness;
      // A site has two bonds of each kind, and the bound is twice the sum over its bonds.
      const double per_length =
        stiffest * (4. * cross_section(*shell, lattice, kind) / (lattice.rest_length(kind) * mass));
      rates.omega_square += per_length * stiffness;
      rates.gamma += per_length * shell->viscosity;
      rates.damped_step = std::min(rates.damped_step, shell->viscosity / stiffness);
    }
  return rates;
}

// Bound for a site with six contacts around it, whose sum n n is 3 I; the bound is twice the sum. As many more contacts
// as sites of a finer grid take the area of one of the lattice.
Rates bound_of_contacts(const TriangularLattice &lattice, const Material &material, const ContactLaw &contact)
{
  const double d = lattice.lattice_spacing();
  const double per_contact = 6. / site_mass(material, lattice) * (half_sqrt3 * d * d / lattice.site_area());
  return {per_contact * contact.stiffness, per_contact * contact.viscosity};
}

TimeStepLimits limits(const TriangularLattice &lattice, const Material &material,
                      const SmallestStretch &smallest_stretch, const std::optional<ContactLaw> &contact,
                      double end_damping = 0.)
{
  const Rates bonds = bound_of_bonds(lattice, material, smallest_stretch);
  const Rates contacts = contact ? bound_of_contacts(lattice, material, *contact) : Rates{};
  return limits(std::max(bonds.omega_square, 0.5 * bonds.omega_square + contacts.omega_square),
                std::max(bonds.gamma, 0.5 * bonds.gamma + std::max(contacts.gamma, end_damping)));
}

} // namespace

TimeStepLimits time_step_limits(const TriangularLattice &lattice, const Material &material, double smallest_stretch,
                                const std::optional<ContactLaw> &contact, const Eigen::Matrix2d &end_impedance)
{
  return limits(lattice, material, SmallestStretch::Constant(smallest_stretch), contact,
                support::symmetric_eigenvalues(end_impedance)[1] / site_mass(material, lattice));
}

double chebyshev_step(const TriangularLattice &lattice, const Material &material, double smallest_stretch,
                      const std::optional<ContactLaw> &contact)
{
  const double step =
    std::min(share_of_elastic_limit * time_step_limits(lattice, material, 1., contact).elastic,
             bound_of_bonds(lattice, material, SmallestStretch::Constant(smallest_stretch)).damped_step);
  if (!contact)
    return step;
  const Rates contacts = bound_of_contacts(lattice, material, *contact);
  return std::min({step, std::cbrt(4. * contacts.gamma / (contacts.omega_square * contacts.omega_square)),
                   site_mass(material, lattice) / contact->viscosity});
}

bool amplifies_contact(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                       const ContactLaw &contact)
{
  const double mass = site_mass(material, lattice);
  const double omega_square = 2. * contact.stiffness / mass, gamma = 2. * contact.viscosity / mass, h = stepping.step;
  if (stepping.stages == 0)
    return h > limits(omega_square, gamma).combined;
  // The roots of lambda^2 + gamma lambda + omega^2 = 0.
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * gamma * gamma - omega_square));
  const ChebyshevStages stages(stepping.stages);
  constexpr double round_off = 1e-12;
  return std::abs(stages.amplification(h * (-0.5 * gamma + root))) > 1. + round_off ||
         std::abs(stages.amplification(h * (-0.5 * gamma - root))) > 1. + round_off;
}

double recoil_step(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                   std::size_t kind, double stretch, const std::optional<ContactLaw> &contact)
{
  SmallestStretch smallest = SmallestStretch::Constant(short_stretch);
  smallest[lattice.shell(kind)] = stretch;
  if (stepping.stages > 0)
    return bound_of_bonds(lattice, material, smallest).damped_step;
  return std::min(limits(lattice, material, smallest, contact).combined,
                  share_for_recoil * limits(lattice, material, smallest, std::nullopt).elastic);
}

double watched_stretch(const TimeStepping &stepping, const TriangularLattice &lattice, const Material &material,
                       double breaking_stretch)
{
  constexpr double most = 0.3;
  if (!std::isfinite(breaking_stretch))
    return short_stretch + most;
  const double loss = stepping.step * largest_stretch_rate(lattice, material, breaking_stretch);
  return short_stretch + (loss < most ? loss : most);
}

double largest_stretch_rate(const TriangularLattice &lattice, const Material &material, double breaking_stretch)
{
  const double stiffest = material.disorder.stiffness.largest();
  double site_energy = 0., of_forces = 0.; // per sheet thickness [J/m], rate [1/s]
  for (std::size_t kind = 0; kind < lattice.n_kinds(); ++kind)
    if (const Shell *shell = material.shell(lattice, kind))
    {
      // No overstress exceeds that of a bond that is stretched at once.
      const double overstress = properties(shell->memory).largest_stiffness * breaking_stretch;
      site_energy += stiffest * cross_section(*shell, lattice, kind) * lattice.rest_length(kind) *
                     (energy(shell->law, breaking_stretch) + 0.5 * overstress * breaking_stretch);
      of_forces = std::max(of_forces, 0.5 * material.coordination(lattice) *
                                        (force(shell->law, breaking_stretch) + overstress) / shell->viscosity);
    }
  // Stiff bonds may pull on one whose dashpot is the weakest.
  of_forces *= stiffest / material.disorder.stiffness.smallest();
  const double of_energy = std::sqrt(8. * site_energy / site_mass(material, lattice)) / lattice.shortest_bond();
  return std::min(of_energy, of_forces);
}

TimeStepping chebyshev_time_stepping(double step, const TimeStepLimits &limits, unsigned int stages)
{
  if (stages == 0)
    return {step, ChebyshevStages::needed(step / limits.viscous)};
  return {std::min(step, ChebyshevStages(stages).real_limit() * limits.viscous), stages};
}

} // namespace latcon::lattice
